#include <nlohmann/json.hpp>

#include "migration.h"
#include "trimtab/preset/json_text.h"
#include "trimtab/preset/preset.h"

namespace trimtab {

namespace {

using Json = nlohmann::ordered_json;

Json number(Range range) {
  Json schema;
  schema["type"] = "number";
  schema["minimum"] = range.low;
  schema["maximum"] = range.high;
  return schema;
}

Json whole(Range range) {
  Json schema = number(range);
  schema["type"] = "integer";
  return schema;
}

/// Describes a list of tuples, each element by its own schema.
Json tuples(std::size_t atLeast, std::size_t atMost, const std::vector<Json>& elements) {
  Json tuple;
  tuple["type"] = "array";
  tuple["minItems"] = elements.size();
  tuple["maxItems"] = elements.size();
  tuple["items"] = elements;
  Json schema;
  schema["type"] = "array";
  schema["minItems"] = atLeast;
  schema["maxItems"] = atMost;
  schema["items"] = tuple;
  return schema;
}

Json valueSchema(const ParameterRow& row) {
  switch (row.kind) {
    case Kind::scalar:
      return row.whole ? whole(row.hard) : number(row.hard);
    case Kind::flag:
      return {{"type", "boolean"}};
    case Kind::choice: {
      Json names = Json::array();
      for (const ChoiceOption& option : row.choices) names.push_back(option.name);
      return {{"enum", names}};
    }
    case Kind::curve:
      return tuples(2, CurvePoints::kCapacity, {number(row.hard), number({0, 1})});
    case Kind::bands: {
      Json low;
      low["type"] = "number";
      low["exclusiveMinimum"] = 0;
      low["exclusiveMaximum"] = BandList::kTop;
      return tuples(1, BandList::kCapacity, {low, whole(row.hard), whole(row.hard)});
    }
    case Kind::lines:
      return {{"type", "array"}, {"items", {{"type", "string"}}}};
  }
  return {};
}

Json parameterSchema(const ParameterRow& row) {
  Json schema;
  schema["title"] = row.label;
  schema["description"] = row.help;
  schema.update(valueSchema(row));
  schema["default"] = Json::parse(json::valueText(row, row.get(TuningParameters{})));
  return schema;
}

Json object(const Json& properties, const std::vector<std::string>& required) {
  return {{"type", "object"}, {"properties", properties}, {"required", required}};
}

}  // namespace

std::string presetSchema() {
  Json parameters;
  std::vector<std::string> keys;
  for (const ParameterRow& row : parameterRows()) {
    parameters[std::string(row.key)] = parameterSchema(row);
    keys.emplace_back(row.key);
  }
  const Json text = {{"type", "string"}};

  Json preset;
  preset["format"] = {{"const", "trimtab-preset"}};
  preset["version"] = {{"const", kPresetVersion}};
  preset["name"] = text;
  preset["base"] = {
      {"type", "string"},
      {"description", "A shipped preset's name or a file beside this one; without it, the defaults"}};
  preset["description"] = text;
  preset["parameters"] = {{"$ref", "#/definitions/parameters"}};

  Json provenance;
  for (const char* const key : {"author", "created", "program", "terrain", "comment"}) provenance[key] = text;
  Json exported;
  exported["format"] = {{"const", "trimtab-export"}};
  exported["version"] = {{"const", kPresetVersion}};
  exported["name"] = text;
  exported["provenance"] = object(provenance, {"author", "created", "program", "terrain", "comment"});
  exported["parameters"] = {{"allOf", {{{"$ref", "#/definitions/parameters"}}, {{"required", keys}}}}};
  exported["checksum"] = {{"type", "string"},
                          {"pattern", "^sha256:[0-9a-f]{64}$"},
                          {"description", "SHA-256 of every byte of the file but these 64 digits"}};

  Json schema;
  schema["$schema"] = "http://json-schema.org/draft-07/schema#";
  schema["title"] = "Trimtab preset";
  schema["description"] =
      "A preset being edited (differences from its base) or a complete export. Keys that are not listed are "
      "kept and have no "
      "effect.";
  schema["oneOf"] = {object(preset, {"format", "version", "parameters"}),
                     object(exported, {"format", "version", "name", "provenance", "parameters", "checksum"})};
  schema["definitions"] = {{"parameters", object(parameters, {})}};
  schema["definitions"]["parameters"].erase("required");
  return schema.dump(2) + "\n";
}

}  // namespace trimtab
