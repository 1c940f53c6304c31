#pragma once

#include <osg/Node>
#include <osgDB/Callbacks>
#include <osgDB/Options>

#include <atomic>
#include <filesystem>
#include <mutex>
#include <set>
#include <string>

#include "trimtab/units/finding_list.h"

namespace trimtab::scene {

/// Reads the files of one scene, its pages too, and notes those that cannot be read. Several threads may read
/// at once.
class PageReads final : public osgDB::ReadFileCallback {
 public:
  explicit PageReads(std::filesystem::path root) : root_(std::move(root)) {}

  /// Returns the scene, or null. Reads of its pages come here from then on.
  osg::ref_ptr<osg::Node> readRoot();
  /// Returns a page, or null; `name` may be relative to the root's folder.
  osg::ref_ptr<osg::Node> readPage(const std::string& name);

  osgDB::ReaderWriter::ReadResult readNode(const std::string& file, const osgDB::Options* options) override;

  std::uint64_t count() const { return count_; }
  std::size_t failed() const;
  Findings findings() const;

 private:
  osg::ref_ptr<osgDB::Options> options();

  std::filesystem::path root_;
  std::atomic<std::uint64_t> count_ = 0;
  mutable std::mutex mutex_;
  std::set<std::string> said_;
  FindingList list_;
};

}  // namespace trimtab::scene
