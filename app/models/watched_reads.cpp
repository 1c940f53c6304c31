#include "app/models/watched_reads.h"

#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/Registry>

#include <algorithm>
#include <array>
#include <vector>

#include "app/models/read_model.h"

namespace trimtab::models {

namespace {

constexpr std::array<const char*, 11> kFormats{"flt", "ive", "osgb", "osgt", "osg", "3ds",
                                               "obj", "ac",  "dae",  "ply",  "stl"};
constexpr std::size_t kMostDeep = 16, kMostFiles = 1000;

/// One name for a file, whatever way leads to it.
std::string nameOf(const std::string& file, const osgDB::Options* options) {
  const std::string found = osgDB::findDataFile(file, options);
  std::error_code error;
  const std::filesystem::path whole = std::filesystem::weakly_canonical(found.empty() ? file : found, error);
  return error ? file : whole.string();
}

}  // namespace

bool isModelName(const std::string& file) {
  const std::string ending = osgDB::getLowerCaseFileExtension(file);
  return std::find(kFormats.begin(), kFormats.end(), ending) != kFormats.end();
}

std::string modelFormats() {
  std::string all;
  for (const char* format : kFormats) all += (all.empty() ? "." : ", .") + std::string(format);
  return all;
}

/// Stands between plugins and the files that they ask for.
class WatchedReads::Files final : public osgDB::ReadFileCallback {
 public:
  explicit Files(WatchedReads& watch) : watch_(watch) {}

  osgDB::ReaderWriter::ReadResult readNode(const std::string& file, const osgDB::Options* options) override {
    const bool isReference = !open_.empty();
    const std::string name = nameOf(file, options);
    std::string why;
    if (osgDB::containsServerAddress(file))
      why = "one on a network, not opened";
    else if (!isModelName(file))
      why = "another one, not opened";
    else if (std::find(open_.begin(), open_.end(), name) != open_.end())
      why = "one inside itself, not opened again";
    else if (open_.size() >= kMostDeep)
      why = "one inside " + std::to_string(kMostDeep) + " others, not opened";
    else if (++count_ > kMostFiles)
      why = "more than " + std::to_string(kMostFiles) + " files, not opened";
    if (!why.empty()) {
      watch_.add(Severity::warning, file, "a reference to a model (" + modelFormats() + ")", why);
      return osgDB::ReaderWriter::ReadResult::ERROR_IN_READING_FILE;
    }
    open_.push_back(name);
    auto result = osgDB::ReadFileCallback::readNode(file, options);
    open_.pop_back();
    if (isReference && !result.validNode())
      watch_.add(Severity::warning, file, "a model that can be read, referred to", "none");
    return result;
  }
  osgDB::ReaderWriter::ReadResult readImage(const std::string& file, const osgDB::Options* options) override {
    if (osgDB::containsServerAddress(file)) {
      watch_.add(Severity::warning, file, "a texture beside the model", "one on a network, not opened");
      return osgDB::ReaderWriter::ReadResult::ERROR_IN_READING_FILE;
    }
    auto result = osgDB::ReadFileCallback::readImage(file, options);
    if (!result.validImage())
      watch_.add(Severity::warning, file,
                 "a texture that can be read, in the model's folder or where the model says",
                 "none: its triangles are drawn in their colour");
    return result;
  }

 private:
  WatchedReads& watch_;
  std::vector<std::string> open_;
  std::size_t count_ = 0;
};

class WatchedReads::Notices final : public osg::NotifyHandler {
 public:
  explicit Notices(WatchedReads& watch) : watch_(watch) {}
  void notify(osg::NotifySeverity, const char* message) override {
    line_ += message;
    for (std::size_t end; (end = line_.find('\n')) != std::string::npos; line_.erase(0, end + 1))
      if (end > 0)
        watch_.add(Severity::note, "", "a model that OpenSceneGraph reads without a word",
                   line_.substr(0, end));
  }

 private:
  WatchedReads& watch_;
  std::string line_;
};

void WatchedReads::add(Severity severity, const std::string& key, const std::string& expected,
                       const std::string& found) {
  if (said_.insert(key + '\n' + found).second) list_.add({severity, model_.string(), key, expected, found});
}

WatchedReads::WatchedReads(std::filesystem::path model)
    : model_(std::move(model)),
      files_(new Files(*this)),
      filesBefore_(osgDB::Registry::instance()->getReadFileCallback()),
      noticesBefore_(osg::getNotifyHandler()),
      levelBefore_(osg::getNotifyLevel()) {
  osgDB::Registry::instance()->setReadFileCallback(files_.get());
  osg::setNotifyHandler(new Notices(*this));
  osg::setNotifyLevel(osg::WARN);
}

WatchedReads::~WatchedReads() {
  osg::setNotifyLevel(levelBefore_);
  osg::setNotifyHandler(noticesBefore_.get());
  osgDB::Registry::instance()->setReadFileCallback(filesBefore_.get());
}

}  // namespace trimtab::models
