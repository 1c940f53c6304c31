#include "page_reads.h"

#include <osg/NodeVisitor>
#include <osg/PagedLOD>
#include <osgDB/ReadFile>

namespace trimtab::scene {
namespace {

/// Makes pages of a read node be read with the same options, so that each of them comes by PageReads.
class HandsDown final : public osg::NodeVisitor {
 public:
  explicit HandsDown(osg::ref_ptr<osgDB::Options> options)
      : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN), options_(std::move(options)) {}
  void apply(osg::PagedLOD& node) override {
    node.setDatabaseOptions(options_.get());
    traverse(node);
  }

 private:
  osg::ref_ptr<osgDB::Options> options_;
};

}  // namespace

osg::ref_ptr<osgDB::Options> PageReads::options() {
  osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
  options->setObjectCacheHint(osgDB::Options::CACHE_NONE);
  options->getDatabasePathList().push_back(root_.parent_path().string());
  options->setReadFileCallback(this);
  return options;
}

osg::ref_ptr<osg::Node> PageReads::readRoot() {
  return osgDB::readRefNodeFile(root_.string(), options().get());
}

osg::ref_ptr<osg::Node> PageReads::readPage(const std::string& name) {
  return osgDB::readRefNodeFile(name, options().get());
}

osgDB::ReaderWriter::ReadResult PageReads::readNode(const std::string& file, const osgDB::Options* given) {
  auto result = osgDB::ReadFileCallback::readNode(file, given);
  if (result.validNode()) {
    HandsDown visitor(options());
    result.getNode()->accept(visitor);
    ++count_;
    return result;
  }
  const std::lock_guard lock(mutex_);
  if (said_.insert(file).second)
    list_.add({Severity::warning, root_.string(), file, "a part of the scene that can be read",
               result.message().empty() ? result.statusMessage() : result.message()});
  return result;
}

std::size_t PageReads::failed() const {
  const std::lock_guard lock(mutex_);
  return said_.size();
}

Findings PageReads::findings() const {
  const std::lock_guard lock(mutex_);
  return list_.all(root_.string());
}

}  // namespace trimtab::scene
