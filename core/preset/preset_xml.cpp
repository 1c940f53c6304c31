#include <pugixml.hpp>

#include "preset_text.h"
#include "trimtab/preset/json_text.h"

namespace trimtab {

namespace {

/// PropertyList, and three parts of a key with a numbered element and its leaf.
constexpr int kDeepest = 8;
constexpr std::size_t kLongestPrefix = 200;
constexpr std::string_view kDeclaredEncodings[] = {"", "UTF-8", "utf-8"};

/// Returns a numbered element as a word of the parameter's plain text: "x:y", "low:WIDTHxHEIGHT", or a rule.
std::string wordOf(const pugi::xml_node& element) {
  const std::string_view name = element.name();
  const auto leaf = [&element](const char* child) { return std::string(element.child_value(child)); };
  if (name == "point") return leaf("x") + ":" + leaf("y");
  if (name == "band") return leaf("low") + ":" + leaf("width") + "x" + leaf("height");
  if (name == "line") return lineAsText(leaf("text"));
  if (name != "rule") return "?";
  const std::string altitude = leaf("altitude"), pitch = leaf("pitch");
  const std::string conditions = pitch == "any"      ? altitude
                                 : altitude == "any" ? pitch
                                                     : altitude + "&" + pitch;
  return conditions + "*" + leaf("weight") + "=" + leaf("output");
}

class Reader {
 public:
  Reader(std::string_view text, const std::string& where)
      : text_(text), where_(where), places_(where, text) {}

  Result<PresetText> read() {
    // An XML reader may expand entities that a document type declares; no export has one.
    if (const std::size_t at = text_.find("<!DOCTYPE"); at != std::string_view::npos)
      return refusal(at, "", "no document type", "<!DOCTYPE");
    pugi::xml_document document;
    const pugi::xml_parse_result parsed = document.load_buffer(
        text_.data(), text_.size(), pugi::parse_default | pugi::parse_declaration, pugi::encoding_utf8);
    if (!parsed)
      return refusal(static_cast<std::size_t>(parsed.offset), "", "a well-formed XML document",
                     parsed.description());
    const std::string_view encoding = document.first_child().attribute("encoding").value();
    if (std::find(std::begin(kDeclaredEncodings), std::end(kDeclaredEncodings), encoding) ==
        std::end(kDeclaredEncodings))
      return refusal(0, "", "the encoding UTF-8", std::string(encoding));
    const pugi::xml_node root = document.document_element();
    if (std::string_view(root.name()) != "PropertyList")
      return refusal(offsetOf(root), "", "a PropertyList", root.name());
    for (const pugi::xml_node child : root.children()) readProperty(child, child.name(), 1);
    if (!findings_.empty()) return findings_.all(where_);
    return std::move(file_);
  }

 private:
  static std::size_t offsetOf(const pugi::xml_node& node) {
    return node.offset_debug() < 0 ? 0 : static_cast<std::size_t>(node.offset_debug());
  }
  Finding refusal(std::size_t at, std::string key, std::string expected, std::string found) {
    return {Severity::error, places_.at(at), std::move(key), std::move(expected), std::move(found)};
  }

  void readProperty(const pugi::xml_node& node, const std::string& key, int depth) {
    if (node.type() != pugi::node_element) return;
    if (depth > kDeepest) {
      findings_.add(refusal(offsetOf(node), key.substr(0, 60),
                            "at most " + std::to_string(kDeepest) + " elements inside each other", "more"));
      return;
    }
    const pugi::xml_node first =
        node.find_child([](const pugi::xml_node& n) { return n.type() == pugi::node_element; });
    if (!first) return add(node, key, node.child_value());
    if (!first.attribute("n")) {
      // The key of each element inside begins with it.
      if (key.size() > kLongestPrefix)
        return findings_.add(refusal(offsetOf(node), key.substr(0, 60),
                                     "at most " + std::to_string(kLongestPrefix) + " characters",
                                     std::to_string(key.size())));
      for (const pugi::xml_node child : node.children())
        readProperty(child, key + "." + child.name(), depth + 1);
      return;
    }
    std::string words;
    for (const pugi::xml_node child : node.children())
      if (child.type() == pugi::node_element)
        words += (words.empty()                              ? ""
                  : std::string_view(child.name()) == "line" ? " | "
                                                             : " ") +
                 wordOf(child);
    add(node, key, words);
  }

  void add(const pugi::xml_node& node, const std::string& key, const std::string& plain) {
    constexpr std::string_view kExport = "export.", kProvenance = "export.provenance.";
    if (key.starts_with(kProvenance)) return;
    const bool isMember = key.starts_with(kExport) || key == "checksum";
    const std::string name = keyOf(key.starts_with(kExport) ? key.substr(kExport.size()) : key);
    const Result<std::string> asJson = jsonOf(name, plain);
    if (asJson) {
      (isMember ? file_.members : file_.parameters).push_back({name, *asJson, places_.at(offsetOf(node))});
      return;
    }
    for (const Finding& f : asJson.findings())
      findings_.add(refusal(offsetOf(node), f.key, f.expected, f.found));
  }

  std::string_view text_;
  const std::string& where_;
  PresetText file_;
  json::Places places_;
  FindingList findings_;
};

}  // namespace

bool looksLikeXml(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  return begin != std::string_view::npos && text[begin] == '<';
}

Result<PresetText> readXmlExport(std::string_view text, const std::string& where) {
  return Reader(text, where).read();
}

}  // namespace trimtab
