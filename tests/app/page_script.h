#pragma once

#include <memory>
#include <pugixml.hpp>
#include <string>

struct duk_hthread;

namespace trimtab::test {

/// The script of a page of resources/report.html, run by Duktape without a document. What it draws is text,
/// so that tests see what a browser would put into the page.
class PageScript {
 public:
  /// Runs the script. Fails the test if the page has none or if it throws.
  explicit PageScript(const std::string& page);

  /// Returns the value of an expression of the script as text; fails the test if it throws.
  std::string valueOf(const std::string& expression);
  /// Returns what the page shows of the JSON that it holds.
  std::string shown() { return valueOf("pageOf(JSON.parse(held))"); }

 private:
  std::string evaluate(const std::string& code);

  std::unique_ptr<duk_hthread, void (*)(duk_hthread*)> engine_;
};

/// Parses a piece of a page, which is well-formed XML. Fails the test if it is not.
pugi::xml_document parsedPage(const std::string& html);
/// Returns all texts below a node with blanks between them.
std::string allText(const pugi::xml_node& node);

}  // namespace trimtab::test
