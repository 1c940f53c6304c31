#pragma once

#include <string>
#include <string_view>

namespace trimtab::experiment {

/// Returns resources/report.html with a JSON document in it: one page that draws the tables and plots of the
/// document in a browser and fetches nothing. The page knows the documents of `bench` and of experiments. No
/// text in the document can end the element that holds it.
std::string pageWith(std::string_view json);

}  // namespace trimtab::experiment
