#include "page_script.h"

#include <duktape.h>
#include <gtest/gtest.h>

namespace trimtab::test {
namespace {

/// Returns the text between the last `begin` of the page and the next `end`.
std::string between(const std::string& page, const std::string& begin, const std::string& end) {
  const std::size_t at = page.rfind(begin);
  if (at == std::string::npos) return {};
  const std::size_t from = at + begin.size();
  return page.substr(from, page.find(end, from) - from);
}

}  // namespace

PageScript::PageScript(const std::string& page) : engine_(duk_create_heap_default(), duk_destroy_heap) {
  const std::string script = between(page, "<script>", "</script>");
  EXPECT_FALSE(script.empty()) << "the page has no script";
  const std::string json = between(page, "<script type=\"application/json\" id=\"data\">", "</script>");
  duk_push_lstring(engine_.get(), json.data(), json.size());
  duk_put_global_string(engine_.get(), "held");
  evaluate(script);
}

std::string PageScript::valueOf(const std::string& expression) {
  return evaluate("String(" + expression + ")");
}

std::string PageScript::evaluate(const std::string& code) {
  duk_context* engine = engine_.get();
  // Compiled as a program: what an evaluation in strict mode declares would be gone after it.
  const bool failed = duk_pcompile_lstring(engine, 0, code.data(), code.size()) != 0 ||
                      duk_pcall(engine, 0) != DUK_EXEC_SUCCESS;
  EXPECT_FALSE(failed) << duk_safe_to_stacktrace(engine, -1);
  std::size_t size = 0;
  const char* text = duk_safe_to_lstring(engine, -1, &size);
  std::string value = failed ? std::string() : std::string(text, size);
  duk_pop(engine);
  return value;
}

pugi::xml_document parsedPage(const std::string& html) {
  pugi::xml_document document;
  const std::string whole = "<body>" + html + "</body>";
  const auto parsed = document.load_string(whole.c_str(), pugi::parse_full | pugi::parse_ws_pcdata);
  EXPECT_TRUE(parsed) << parsed.description() << " near "
                      << whole.substr(static_cast<std::size_t>(parsed.offset), 80);
  return document;
}

std::string allText(const pugi::xml_node& node) {
  std::string text;
  for (const auto& found : node.select_nodes(".//text()")) text += std::string(found.node().value()) + ' ';
  return text;
}

}  // namespace trimtab::test
