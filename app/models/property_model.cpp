#include "app/models/property_model.h"

#include <osg/Group>
#include <osg/LOD>
#include <osg/MatrixTransform>
#include <osg/NodeVisitor>
#include <osgDB/FileNameUtils>
#include <osgDB/ReadFile>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <filesystem>
#include <map>
#include <pugixml.hpp>
#include <set>
#include <vector>

#include "trimtab/preset/file_io.h"
#include "trimtab/units/number.h"

namespace trimtab::models {

namespace {

namespace fs = std::filesystem;

/// Offsets and ranges beyond are no model's, metres and degrees.
constexpr double kMostOffset = 1e5, kMostRangeM = 1e7;
constexpr int kMostFoldersUp = 16, kMostNested = 64;

std::string textOf(const pugi::xml_node& node) {
  const std::string text = node.text().get();
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

/// Compares a property that is not set with a value: below 0, 0 or above it; as texts if it is no number.
int compareUnset(const pugi::xml_node& comparison) {
  const std::string value = textOf(comparison.child("value"));
  const std::optional<double> number = readNumber(value);
  if (!number) return value.empty() ? 0 : -1;
  return *number > 0 ? -1 : *number < 0 ? 1 : 0;
}

/// Tells whether a condition holds while no property is set.
bool holdsUnset(const pugi::xml_node& condition, int depth = 0) {
  const std::string name = condition.name();
  if (depth > kMostNested || name == "property") return false;
  if (name == "less-than") return compareUnset(condition) < 0;
  if (name == "less-than-equals") return compareUnset(condition) <= 0;
  if (name == "greater-than") return compareUnset(condition) > 0;
  if (name == "greater-than-equals") return compareUnset(condition) >= 0;
  if (name == "equals") return compareUnset(condition) == 0;
  if (name == "not-equals") return compareUnset(condition) != 0;
  const bool any = name == "or";
  for (const pugi::xml_node& part : condition.children())
    if (part.type() == pugi::node_element && holdsUnset(part, depth + 1) == any)
      return any != (name == "not");
  return any == (name == "not");
}

/// Finds the nodes of some names; not what is inside them.
class NamedNodes final : public osg::NodeVisitor {
 public:
  explicit NamedNodes(std::set<std::string> names)
      : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN), names_(std::move(names)) {
    setNodeMaskOverride(0xffffffffu);
  }
  void apply(osg::Node& node) override {
    if (names_.contains(node.getName()) && node.getNumParents() > 0)
      found_.emplace_back(&node);
    else
      traverse(node);
  }
  const std::vector<osg::ref_ptr<osg::Node>>& found() const { return found_; }

 private:
  std::set<std::string> names_;
  std::vector<osg::ref_ptr<osg::Node>> found_;
};

class ListedModel {
 public:
  ListedModel(std::string file, const osgDB::Options* options, const SayOfModel& say)
      : file_(std::move(file)), options_(options), say_(say) {}

  osg::ref_ptr<osg::Node> read() {
    const auto text = readWhole(file_);
    if (!text) {
      for (const Finding& finding : text.findings())
        say_(Severity::warning, file_, finding.expected, finding.found);
      return {};
    }
    pugi::xml_document document;
    const pugi::xml_parse_result parsed = document.load_buffer(text->data(), text->size());
    if (!parsed)
      say_(Severity::warning, file_, "XML to its end",
           std::string(parsed.description()) + " at byte " + std::to_string(parsed.offset));
    const pugi::xml_node root = document.child("PropertyList");
    if (root.attribute("include"))
      say_(Severity::note, file_, "a list of its own",
           "one that includes " + std::string(root.attribute("include").value()) + ", which is not read");
    const osg::ref_ptr<osg::MatrixTransform> all = new osg::MatrixTransform(offsetsOf(root));
    if (const std::string path = textOf(root.child("path")); !path.empty()) add(path, *all);
    for (const pugi::xml_node& inner : root.children("model")) {
      const std::string path = textOf(inner.child("path"));
      const pugi::xml_node condition = inner.child("condition");
      if (path.empty() || (condition && !holdsUnset(condition))) continue;
      const osg::ref_ptr<osg::MatrixTransform> moved = new osg::MatrixTransform(offsetsOf(inner));
      moved->setName(textOf(inner.child("name")));
      if (add(path, *moved)) all->addChild(moved);
    }
    if (all->getNumChildren() == 0) return {};
    const osg::ref_ptr<osg::Group> top = new osg::Group;
    top->addChild(all);
    for (const pugi::xml_node& animation : root.children("animation")) animate(animation, *top, *all);
    std::string others;
    for (const auto& [type, count] : others_)
      others += (others.empty() ? "" : ", ") + std::to_string(count) + ' ' + type;
    if (!others.empty())
      say_(Severity::note, osgDB::getSimpleFileName(file_), "animations of type range and select",
           "also " + others + ": drawn as without them");
    return top;
  }

 private:
  bool add(const std::string& path, osg::Group& to) const {
    const std::string found = fileOf(path);
    if (found.empty()) {
      say_(Severity::warning, path, "a model's file beside " + file_ + ", or below a folder above it",
           "none");
      return false;
    }
    const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(found, options_);
    if (!node) return false;
    if (osgDB::getLowerCaseFileExtension(found) != "ac") return to.addChild(node);
    const osg::ref_ptr<osg::MatrixTransform> up =
        new osg::MatrixTransform(osg::Matrix(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1));
    up->addChild(node);
    return to.addChild(up);
  }

  std::string fileOf(const std::string& path) const {
    std::error_code error;
    fs::path folder = fs::absolute(file_, error).parent_path();
    for (int i = 0; i < kMostFoldersUp; ++i, folder = folder.parent_path()) {
      if (fs::is_regular_file(folder / path, error)) return (folder / path).lexically_normal().string();
      if (folder == folder.parent_path()) break;
    }
    return {};
  }

  double numberIn(const pugi::xml_node& parent, const char* name, double otherwise, double most) const {
    const pugi::xml_node node = parent.child(name);
    if (!node) return otherwise;
    const std::optional<double> value = readNumber(textOf(node));
    if (value && std::abs(*value) <= most) return *value;
    say_(Severity::warning, std::string(name) + " in " + file_,
         "a number from " + numberText(-most) + " to " + numberText(most), textOf(node) + ", not used");
    return otherwise;
  }

  osg::Matrix offsetsOf(const pugi::xml_node& node) const {
    const pugi::xml_node offsets = node.child("offsets");
    const auto number = [&](const char* name) { return numberIn(offsets, name, 0, kMostOffset); };
    osg::Matrix turn;
    turn.makeRotate(osg::DegreesToRadians(number("pitch-deg")), osg::Vec3(0, 1, 0),
                    osg::DegreesToRadians(number("roll-deg")), osg::Vec3(1, 0, 0),
                    osg::DegreesToRadians(number("heading-deg")), osg::Vec3(0, 0, 1));
    return turn * osg::Matrix::translate(number("x-m"), number("y-m"), number("z-m"));
  }

  void animate(const pugi::xml_node& animation, osg::Group& top, osg::Node& whole) {
    const std::string type = textOf(animation.child("type"));
    const bool range = type == "range";
    if (!range && type != "select") {
      if (!type.empty()) ++others_[type];  // one without a type only groups objects
      return;
    }
    const double from = range ? numberIn(animation, "min-m", 0, kMostRangeM) : 0,
                 to = range ? numberIn(animation, "max-m", FLT_MAX, kMostRangeM) : 0;
    const pugi::xml_node condition = animation.child("condition");
    if (range ? from <= 0 && to >= kMostRangeM : !condition || holdsUnset(condition)) return;
    std::set<std::string> names;
    for (const pugi::xml_node& name : animation.children("object-name")) names.insert(textOf(name));
    std::vector<osg::ref_ptr<osg::Node>> nodes;
    if (names.empty()) {
      nodes.emplace_back(&whole);
    } else {
      NamedNodes named(names);
      top.accept(named);
      nodes = named.found();
    }
    for (const osg::ref_ptr<osg::Node>& node : nodes) {
      const osg::ref_ptr<osg::LOD> lod = new osg::LOD;
      // A range of nothing hides, but both ends 0 would say nothing.
      if (range) lod->addChild(node, static_cast<float>(from), static_cast<float>(std::max(to, from)));
      // The parents change while they are replaced.
      const osg::Node::ParentList parents = node->getParents();
      for (osg::Group* const parent : parents)
        if (parent != lod.get()) parent->replaceChild(node, lod);
    }
  }

  std::string file_;
  const osgDB::Options* options_;
  const SayOfModel& say_;
  std::map<std::string, std::size_t> others_;
};

}  // namespace

osg::ref_ptr<osg::Node> readPropertyModel(const std::string& file, const osgDB::Options* options,
                                          const SayOfModel& say) {
  return ListedModel(file, options, say).read();
}

}  // namespace trimtab::models
