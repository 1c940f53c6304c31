#include "app/models/watched_reads.h"

#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/Registry>

#include <algorithm>
#include <array>
#include <sstream>
#include <vector>

#include "app/models/open_flight.h"
#include "app/models/property_model.h"
#include "app/models/read_model.h"
#include "trimtab/terrain/cdb/models.h"

namespace trimtab::models {

namespace {

constexpr std::array<const char*, 12> kFormats{"flt", "ive", "osgb", "osgt", "osg", "3ds",
                                               "obj", "ac",  "dae",  "ply",  "stl", "xml"};
constexpr std::size_t kMostDeep = 16, kMostFiles = 1000;

using ReadResult = osgDB::ReaderWriter::ReadResult;

bool isInArchive(const std::string& file) {
  return file.starts_with("/vsizip/");
}

osgDB::ReaderWriter* readerOf(const std::string& file) {
  return osgDB::Registry::instance()->getReaderWriterForExtension(osgDB::getLowerCaseFileExtension(file));
}

/// Reads a model from its bytes: one in an archive, and OpenFlight, whose levels need ranges first.
ReadResult readBytes(const std::string& file, const osgDB::Options* options) {
  osgDB::ReaderWriter* const reader = readerOf(file);
  if (reader == nullptr) return ReadResult::FILE_NOT_HANDLED;
  const std::string found = isInArchive(file) ? file : osgDB::findDataFile(file, options);
  if (found.empty()) return ReadResult::FILE_NOT_FOUND;
  auto bytes = terrain::bytesOfFile(found);
  if (!bytes) return ReadResult(bytes.findings().front().found);
  const osg::ref_ptr<osgDB::Options> local =
      options != nullptr ? options->cloneOptions() : new osgDB::Options;
  local->getDatabasePathList().push_front(osgDB::getFilePath(found));
  const bool flight = osgDB::getLowerCaseFileExtension(file) == "flt";
  std::istringstream in(flight ? withRangesBySize(std::move(bytes).value()) : std::move(bytes).value());
  return reader->readNode(in, local.get());
}

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

ReadResult imageInArchive(const std::string& file, const osgDB::Options* options) {
  osgDB::ReaderWriter* const reader = readerOf(file);
  const auto bytes = terrain::bytesOfFile(file);
  if (reader == nullptr || !bytes) return ReadResult::ERROR_IN_READING_FILE;
  std::istringstream in(*bytes);
  return reader->readImage(in, options);
}

/// Finds textures of a CDB, whose level is often another one than the model names.
class WatchedReads::Textures final : public osgDB::FindFileCallback {
 public:
  explicit Textures(std::string model) : model_(std::move(model)) {}
  std::string findDataFile(const std::string& file, const osgDB::Options* options,
                           osgDB::CaseSensitivity caseSensitivity) override {
    std::string found = osgDB::FindFileCallback::findDataFile(file, options, caseSensitivity);
    if (!found.empty() || isModelName(file)) return found;
    return terrain::cdbTexture(file, model_).value_or("");
  }

 private:
  std::string model_;
};

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
    auto result = readOne(file, options);
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
    auto result =
        isInArchive(file) ? imageInArchive(file, options) : osgDB::ReadFileCallback::readImage(file, options);
    if (!result.validImage())
      watch_.add(Severity::warning, file,
                 "a texture that can be read, in the model's folder or where the model says",
                 "none: its triangles are drawn in their colour");
    return result;
  }

 private:
  osgDB::ReaderWriter::ReadResult readOne(const std::string& file, const osgDB::Options* options) {
    const std::string ending = osgDB::getLowerCaseFileExtension(file);
    if (ending == "xml") {
      const auto node = readPropertyModel(file, options, [this](auto&&... said) { watch_.add(said...); });
      return node ? ReadResult(node.get()) : ReadResult(ReadResult::ERROR_IN_READING_FILE);
    }
    if (isInArchive(file) || ending == "flt") return readBytes(file, options);
    return osgDB::ReadFileCallback::readNode(file, options);
  }

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
      findBefore_(osgDB::Registry::instance()->getFindFileCallback()),
      filesBefore_(osgDB::Registry::instance()->getReadFileCallback()),
      noticesBefore_(osg::getNotifyHandler()),
      levelBefore_(osg::getNotifyLevel()) {
  osgDB::Registry::instance()->setReadFileCallback(files_.get());
  osgDB::Registry::instance()->setFindFileCallback(new Textures(model_.string()));
  osg::setNotifyHandler(new Notices(*this));
  osg::setNotifyLevel(osg::WARN);
}

WatchedReads::~WatchedReads() {
  osg::setNotifyLevel(levelBefore_);
  osg::setNotifyHandler(noticesBefore_.get());
  osgDB::Registry::instance()->setFindFileCallback(findBefore_.get());
  osgDB::Registry::instance()->setReadFileCallback(filesBefore_.get());
}

}  // namespace trimtab::models
