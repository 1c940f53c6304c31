#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "html_model.h"

/// The page, section by section. A section that has nothing to show says so.
namespace trimtab::harness {

/// The frame times and errors of a flight's units as points, with the front that none of them beats in both.
plot::Plot paretoOf(const ReportModel& model, const std::string& flight, const Quantity& error);
/// What frame time is held against: errors that were measured, FLIP first.
std::vector<const Quantity*> paretoErrors(const ReportModel& model);
/// Indices of the points that no other beats in both; from the smallest x.
std::vector<std::size_t> frontOf(const std::vector<double>& x, const std::vector<double>& y);

std::string headSection(const ReportModel& model);
std::string paretoSection(const ReportModel& model);
std::string summarySection(const ReportModel& model);
std::string stagesSection(const ReportModel& model);
std::string flightSection(const ReportModel& model);
std::string skipsSection(const ReportModel& model);
std::string comparisonSection(const ReportModel& model);
std::string worstSection(const ReportModel& model, const std::filesystem::path& folder);

/// Colours of presets and shapes of cases, once for many plots.
std::string legend(const std::vector<plot::Key>& keys);

}  // namespace trimtab::harness
