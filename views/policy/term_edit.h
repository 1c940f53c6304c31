// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>
#include <optional>
#include <vector>

#include "trimtab/policy/policy.h"
#include "views/editors/edit_points.h"
#include "views/model/rounded.h"

/// What the editor of terms does to their numbers; no widgets here.
namespace trimtab::views {

/// Returns the characteristic points of a term: those of a polygon, feet and tops, or the middle and the
/// places that give width and slope. Empty for numbers that the shape does not take.
std::vector<EditPoint> handlesOf(const PolicyTerm& term, Range view);

/// Returns the term with one point moved to (x, y), or as near as its neighbours allow: `gap` stays between
/// them, so that every result compiles. What the point does not move along is ignored.
PolicyTerm withHandleAt(const PolicyTerm& term, std::size_t handle, double x, double y, double gap);

/// Returns the term with several points moved together by (dx, dy), or by as much as the first that meets a
/// neighbour or an end of the membership allows. A foot at infinity stays there unless it is moved alone,
/// from the end of the view; points that give a width go with their middle.
PolicyTerm withHandlesMoved(const PolicyTerm& term, const std::vector<std::size_t>& handles, double dx,
                            double dy, double gap, Range view = {});

/// Returns the term in another shape with about the same feet, tops and half-way points.
PolicyTerm withShape(const PolicyTerm& term, TermShape shape, Range view);

struct InsertedPoint {
  PolicyTerm term;
  std::size_t handle = 0;
};
/// Return a term of the shape `points` with one more point or one fewer; nothing for other shapes, or if it
/// would have too many or fewer than two.
std::optional<InsertedPoint> withPoint(const PolicyTerm& term, double x, double y);
std::optional<PolicyTerm> withoutPoint(const PolicyTerm& term, std::size_t handle);

/// Returns a term in the middle of what the view shows.
PolicyTerm newTerm(Signal signal, const std::string& name, Range view);

/// Returns what the plot of a signal shows at first: what its terms cover, or the whole range.
Range viewOf(Signal signal, const std::vector<PolicyTerm>& terms);

/// Returns the step by which keys move a point in a view of this size: a round number.
double nudgeStep(Range view);

/// Returns the numbers of a term as people type them: "-inf 0 500 1500".
QString numbersText(const PolicyTerm& term);
/// Reads such numbers; returns nothing if a word is no number.
std::optional<std::vector<double>> readNumbers(const QString& text);
/// Returns which numbers a shape takes, in words.
QString numbersHelp(TermShape shape);

}  // namespace trimtab::views
