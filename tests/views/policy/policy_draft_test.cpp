// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/policy/policy_draft.h"

#include "policy_flight.h"
#include "tests/views/application.h"
#include "trimtab/preset/policy_lines.h"
#include "views/policy/policy_panel.h"
#include "views/policy/signals_list.h"
#include "views/policy/term_plot.h"

namespace trimtab::views {
namespace {

const TextLines kTerms{{"above_ground   low  =  points 0 1  500 0.5 1000 0", "speed fast = ramp  200 400",
                        "speed slow = ramp 400.0 2e2"}};
const TextLines kRules{{"if above_ground is low  then lod_scale = 2  # near the ground,  say",
                        "off if speed is fast then lod_scale = 0.50"}};

void set(Draft& draft, const TextLines& terms, const TextLines& rules) {
  draft.setValue("policy.terms", terms);
  draft.setValue("policy.rules", rules);
  draft.undoStack().clear();
}

TEST(PolicyDraft, aDragWritesItsLineAndLeavesTheOthersLetterByLetter) {
  Draft draft;
  PolicyPanel panel(draft);
  set(draft, kTerms, kRules);
  ASSERT_FALSE(draft.isBroken()) << toString(draft.findings());
  test::expose(panel, {640, 760});
  panel.parts().signalsList->choose(Signal::above_ground);
  QCoreApplication::processEvents();
  TermPlot& plot = *panel.parts().plot;
  const EditPoint at = plot.points().at(1);
  test::drag(plot, plot.pixelOf(at.x, at.y), plot.pixelOf(at.x, at.y) + QPointF(13, 7));
  const auto now = [&] { return draft.parameters().policy; };
  EXPECT_NE(now().terms.line[0], kTerms.line[0]);
  EXPECT_EQ(now().terms.line[1], kTerms.line[1]);
  EXPECT_EQ(now().terms.line[2], kTerms.line[2]);
  EXPECT_EQ(now().rules, kRules) << "reasons and blanks too";
  EXPECT_EQ(draft.active()->policy, now()) << "what runs follows";
  draft.undoStack().undo();
  EXPECT_EQ(now().terms, kTerms);
  EXPECT_EQ(now().rules, kRules);
}

TEST(PolicyDraft, theTermThatIsKeptIsBitByBitTheOneThatItsTextSays) {
  Draft draft;
  PolicyDraft policy(draft);
  set(draft, kTerms, kRules);
  PolicyTerm term = *policy.terms()[1].term;
  for (const double x : {0.1 + 0.2, 1.0 / 3, 1e-7, 123456.789}) {
    term.numbers = {x, 400};
    policy.putTerm(1, term, QStringLiteral("Move"));
    EXPECT_EQ(policy.terms()[1].term, term);
    const auto read = policyOf(draft.parameters().policy);
    ASSERT_TRUE(read);
    EXPECT_EQ(read->terms[1], term) << draft.parameters().policy.terms.line[1];
    EXPECT_EQ(policy.active(), *read);
  }
  while (draft.undoStack().canUndo()) draft.undoStack().undo();
  EXPECT_EQ(policy.terms()[1].text, kTerms.line[1]);
  EXPECT_EQ(policy.terms()[1].term->numbers, (std::vector<double>{200, 400}));
}

TEST(PolicyDraft, aLineThatCannotBeReadStaysAsItIs) {
  Draft draft;
  PolicyDraft policy(draft);
  TextLines terms = kTerms;
  terms.line.insert(terms.line.begin() + 1, "speed = what is this");
  set(draft, kTerms, kRules);
  draft.setValue("policy.terms", terms);
  ASSERT_TRUE(draft.isBroken());
  EXPECT_FALSE(policy.terms()[1].term);
  EXPECT_EQ(policy.active().terms.size(), 3u) << "the last valid policy runs";
  PolicyTerm term = *policy.terms()[0].term;
  term.numbers[2] = 600;
  policy.putTerm(0, term, QStringLiteral("Move"));
  EXPECT_EQ(draft.parameters().policy.terms.line[1], terms.line[1]);
  policy.removeTerm(1);
  EXPECT_FALSE(draft.isBroken());
  EXPECT_EQ(policy.active().terms[0], term);
}

}  // namespace
}  // namespace trimtab::views
