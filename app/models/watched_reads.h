#pragma once

#include <osg/Notify>
#include <osgDB/Callbacks>

#include <filesystem>
#include <set>
#include <string>

#include "trimtab/units/finding_list.h"

namespace trimtab::models {

/// Tells whether readModel() reads files of this name.
bool isModelName(const std::string& file);

/// Watches all that OpenSceneGraph opens and says while this object lives: one at a time in a program.
class WatchedReads {
 public:
  explicit WatchedReads(std::filesystem::path model);
  ~WatchedReads();
  WatchedReads(const WatchedReads&) = delete;
  WatchedReads& operator=(const WatchedReads&) = delete;

  /// What was refused or is not there, and what OpenSceneGraph said.
  Findings findings() const { return list_.all(model_.string()); }

 private:
  class Files;
  class Notices;
  class Textures;
  /// Adds a finding, once.
  void add(Severity severity, const std::string& key, const std::string& expected, const std::string& found);

  std::filesystem::path model_;
  FindingList list_;
  std::set<std::string> said_;
  osg::ref_ptr<Files> files_;
  osg::ref_ptr<osgDB::FindFileCallback> findBefore_;
  osg::ref_ptr<osgDB::ReadFileCallback> filesBefore_;
  osg::ref_ptr<osg::NotifyHandler> noticesBefore_;
  osg::NotifySeverity levelBefore_;
};

}  // namespace trimtab::models
