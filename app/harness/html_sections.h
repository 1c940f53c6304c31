#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "html_model.h"

/// The sections of the HTML page. A section that has nothing to show says so.
namespace trimtab::harness {

/// Plots the frame times and errors of a flight's units as points, with the Pareto front.
plot::Plot paretoOf(const ReportModel& model, const std::string& flight, const Quantity& error);
/// Returns the errors that frame time is plotted against: those that were measured, FLIP first.
std::vector<const Quantity*> paretoErrors(const ReportModel& model);

std::string headSection(const ReportModel& model);
std::string paretoSection(const ReportModel& model);
std::string summarySection(const ReportModel& model);
std::string stagesSection(const ReportModel& model);
std::string flightSection(const ReportModel& model);
std::string skipsSection(const ReportModel& model);
std::string comparisonSection(const ReportModel& model);
std::string worstSection(const ReportModel& model, const std::filesystem::path& folder);

/// Returns one legend for many plots: colours of presets and shapes of cases.
std::string legend(const std::vector<plot::Key>& keys);

}  // namespace trimtab::harness
