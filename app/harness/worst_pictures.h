#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "results.h"

namespace trimtab::harness {

/// The images of all worst frames for a page, at the largest width at which the page can still be sent to
/// somebody. Files of the same content are one picture.
class WorstPictures {
 public:
  struct Picture {
    std::string base64;   ///< of a PNG file; empty if `problem` says why there is none
    std::string problem;  ///< "gone.png: it cannot be read"
    int widthPx = 0, heightPx = 0;
  };

  /// Reads the images from `folder`. A name that leads out of the folder is a problem and is not read.
  WorstPictures(const Results& results, const std::filesystem::path& folder);

  const std::vector<Picture>& all() const { return pictures_; }
  /// Returns the index of a file of a worst frame in all().
  std::size_t indexOf(const std::string& name) const { return indices_.at(name); }
  int widthPx() const { return widthPx_; }

 private:
  void read(const Results& results, const std::filesystem::path& folder);
  void add(const std::filesystem::path& folder, const std::string& name);

  std::vector<Picture> pictures_;
  std::map<std::string, std::size_t> indices_;
  std::size_t bytes_ = 0;
  int widthPx_ = 0;
};

}  // namespace trimtab::harness
