#include <algorithm>
#include <array>

#include "migration.h"
#include "trimtab/preset/json_text.h"
#include "trimtab/preset/preset.h"
#include "trimtab/preset/sealed.h"
#include "trimtab/units/number.h"

namespace trimtab {

namespace {

using Field = std::pair<std::string_view, const std::string*>;

std::array<Field, 5> fieldsOf(const Provenance& p) {
  return {{{"author", &p.author},
           {"created", &p.created},
           {"program", &p.program},
           {"terrain", &p.terrain},
           {"comment", &p.comment}}};
}

std::string asJson(const TuningParameters& parameters, const std::string& name,
                   const Provenance& provenance) {
  std::string text =
      "{\n  \"format\": \"trimtab-export\",\n  \"version\": " + std::to_string(kPresetVersion) +
      ",\n  \"name\": " + json::stringText(name) + ",\n  \"provenance\": {";
  const char* lead = "\n    ";
  for (const auto& [key, value] : fieldsOf(provenance)) {
    text += lead + json::stringText(key) + ": " + json::stringText(*value);
    lead = ",\n    ";
  }
  text += "\n  },\n  \"parameters\": {";
  lead = "\n    ";
  for (const ParameterRow& row : parameterRows()) {
    text += lead + json::stringText(row.key) + ": " + json::valueText(row, row.get(parameters));
    lead = ",\n    ";
  }
  return text + "\n  },\n  \"checksum\": \"" + checksumBlank() + "\"\n}\n";
}

/// Text as XML takes it; control characters, which XML 1.0 cannot carry, become blanks.
std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else if (c == '\r')
      result += "&#13;";
    else if (static_cast<unsigned char>(c) < ' ' && c != '\n' && c != '\t')
      result += ' ';
    else
      result += c;
  }
  return result;
}

/// Nested elements of a FlightGear property list, opened and closed as paths ask for.
class PropertyList {
 public:
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<PropertyList>\n";

  /// Makes the open elements those of a dotted path.
  void enter(std::string_view path) {
    std::vector<std::string> wanted;
    while (!path.empty()) {
      const std::size_t dot = std::min(path.find('.'), path.size());
      wanted.emplace_back(path.substr(0, dot));
      path.remove_prefix(std::min(dot + 1, path.size()));
    }
    const auto common =
        std::mismatch(open_.begin(), open_.end(), wanted.begin(), wanted.end()).first - open_.begin();
    while (open_.size() > static_cast<std::size_t>(common)) {
      const std::string name = open_.back();
      open_.pop_back();
      line("</" + name + ">");
    }
    for (std::size_t i = open_.size(); i < wanted.size(); ++i) {
      line("<" + wanted[i] + ">");
      open_.push_back(wanted[i]);
    }
  }
  void leaf(const std::string& name, std::string_view type, std::string_view value) {
    line("<" + name + " type=\"" + std::string(type) + "\">" + escaped(value) + "</" + name + ">");
  }
  /// Writes the n-th of several elements of one name, with leaves inside.
  void indexed(const std::string& name, std::size_t n,
               const std::vector<std::array<std::string, 3>>& leaves) {
    line("<" + name + " n=\"" + std::to_string(n) + "\">");
    open_.push_back(name);
    for (const auto& [leafName, type, value] : leaves) leaf(leafName, type, value);
    open_.pop_back();
    line("</" + name + ">");
  }

 private:
  void line(const std::string& content) { text += std::string(2 * open_.size() + 2, ' ') + content + '\n'; }

  std::vector<std::string> open_;
};

void addProperty(PropertyList& list, const ParameterRow& row, const ParameterValue& value) {
  const std::size_t dot = row.key.rfind('.');
  const std::string name(row.key.substr(dot + 1));
  if (row.kind == Kind::curve || row.kind == Kind::bands || row.kind == Kind::lines)
    list.enter(row.key);
  else
    list.enter(row.key.substr(0, dot));
  switch (row.kind) {
    case Kind::scalar:
      return list.leaf(name, row.whole ? "int" : "double", toText(row, value));
    case Kind::flag:
      return list.leaf(name, "bool", toText(row, value));
    case Kind::choice:
      return list.leaf(name, "string", toText(row, value));
    case Kind::curve:
      for (std::size_t n = 0; const CurvePoint& p : std::get<CurvePoints>(value).span())
        list.indexed("point", n++, {{"x", "double", numberText(p.x)}, {"y", "double", numberText(p.y)}});
      return;
    case Kind::bands:
      for (std::size_t n = 0; const Band& b : std::get<BandList>(value).span())
        list.indexed("band", n++,
                     {{"low", "double", numberText(b.low)},
                      {"width", "int", std::to_string(b.widthPx)},
                      {"height", "int", std::to_string(b.heightPx)}});
      return;
    case Kind::lines:
      for (std::size_t n = 0; const std::string& text : std::get<TextLines>(value).line)
        list.indexed("line", n++, {{"text", "string", text}});
      return;
  }
}

std::string asXml(const TuningParameters& parameters, const std::string& name, const Provenance& provenance) {
  PropertyList list;
  list.enter("export");
  list.leaf("format", "string", "trimtab-export");
  list.leaf("version", "int", std::to_string(kPresetVersion));
  list.leaf("name", "string", name);
  list.enter("export.provenance");
  for (const auto& [key, value] : fieldsOf(provenance)) list.leaf(std::string(key), "string", *value);
  list.enter("");
  for (const ParameterRow& row : parameterRows()) addProperty(list, row, row.get(parameters));
  list.enter("");
  list.leaf("checksum", "string", checksumBlank());
  return list.text + "</PropertyList>\n";
}

/// Returns the text on one line: backslash, line ends and tabs by a backslash, other control characters as
/// blanks.
std::string oneLine(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '\\')
      result += "\\\\";
    else if (c == '\n')
      result += "\\n";
    else if (c == '\r')
      result += "\\r";
    else if (c == '\t')
      result += "\\t";
    else
      result += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return result;
}

std::string asIni(const TuningParameters& parameters, const std::string& name, const Provenance& provenance) {
  std::string text =
      "; Curves are x:y points, bands low:WIDTHxHEIGHT, rules conditions*weight=output; lines of a policy "
      "are "
      "separated by |, and \\| and \\\\ in them are escapes; units are in the keys. In texts \\n, \\r, \\t "
      "and \\\\ are escapes.\n"
      "[export]\nformat = trimtab-export\nversion = " +
      std::to_string(kPresetVersion) + "\nname = " + oneLine(name) + "\n\n[provenance]\n";
  for (const auto& [key, value] : fieldsOf(provenance))
    text += std::string(key) + " = " + oneLine(*value) + "\n";
  text += "\n[parameters]\n";
  for (const ParameterRow& row : parameterRows())
    text += std::string(row.key) + " = " + toText(row, row.get(parameters)) + "\n";
  return text + "\n[seal]\nchecksum = " + checksumBlank() + "\n";
}

}  // namespace

std::string machineNote(const TuningParameters& parameters) {
  if (parameters.culling.occlusion != OcclusionMethod::automatic) return {};
  return "culling.occlusion is auto: whether hidden ground is looked for, and so what a frame costs, depends "
         "on the machine.";
}

std::string exportText(const ValidatedParameters& parameters, const std::string& name,
                       const Provenance& provenance, ExportFormat format) {
  switch (format) {
    case ExportFormat::json:
      return sealed(asJson(*parameters, name, provenance));
    case ExportFormat::xml:
      return sealed(asXml(*parameters, name, provenance));
    case ExportFormat::ini:
      return sealed(asIni(*parameters, name, provenance));
  }
  return {};
}

}  // namespace trimtab
