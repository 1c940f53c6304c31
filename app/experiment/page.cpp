#include "page.h"

namespace trimtab::experiment {

/// Written by CMakeLists.txt from resources/report.html.
extern const char* const kPageTemplate;

namespace {

constexpr std::string_view kMarker = "@DATA@";

/// JSON has these characters in strings only, where escapes say the same. HTML would read `<` as the
/// beginning of a tag, and JavaScript reads the separators U+2028 and U+2029 as ends of lines.
std::string withoutMarkup(std::string_view json) {
  std::string text;
  text.reserve(json.size());
  for (std::size_t at = 0; at < json.size(); ++at) {
    const std::string_view three = json.substr(at, 3);
    if (json[at] == '<') {
      text += "\\u003c";
    } else if (three == "\xe2\x80\xa8" || three == "\xe2\x80\xa9") {
      text += three.back() == '\xa8' ? "\\u2028" : "\\u2029";
      at += 2;
    } else {
      text += json[at];
    }
  }
  return text;
}

}  // namespace

std::string pageWith(std::string_view json) {
  std::string page = kPageTemplate;
  return page.replace(page.find(kMarker), kMarker.size(), withoutMarkup(json));
}

}  // namespace trimtab::experiment
