#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "trimtab/terrain/cdb/catalogue.h"
#include "trimtab/units/finding_list.h"

namespace trimtab::terrain {

/// Which model a feature has, by its class.
struct CdbModelName {
  std::string facc;          ///< "AL015"
  int subcode = 0;           ///< FSC
  std::string model;         ///< MODL
  std::string text() const;  ///< "AL015_000_harbor_club"
};

/// Finds the files of models. Names of an archive's files begin with "/vsizip/", which GDAL and
/// app/models read.
class CdbModels {
 public:
  /// The catalogue must outlive this object.
  explicit CdbModels(const CdbCatalogue& cdb);

  /// Returns the file of a model that many features share (GTModel/500_GTModelGeometry).
  std::optional<std::string> typical(const CdbModelName& name) const;
  /// Returns the file of a model of one place (300_GSModelGeometry): in the archive of level `mlod` of the
  /// feature's cell that covers the feature.
  std::optional<std::string> specific(const CdbTile& feature, double longitude, double latitude, int mlod,
                                      const CdbModelName& name);
  /// Returns archives that cannot be read.
  Findings findings() const { return findings_.all(cdb_.root.string()); }

 private:
  using Files = std::map<std::string, std::string>;  ///< by name in lower case
  const Files& inArchive(const std::filesystem::path& archive);

  const CdbCatalogue& cdb_;
  Files typical_;
  std::map<CdbTile, std::filesystem::path> archives_;
  std::map<std::filesystem::path, Files> inside_;
  FindingList findings_;
};

/// Returns the bytes of a file on disk or, as "/vsizip/ARCHIVE/NAME", inside an archive; fails with the
/// reason. A file inside an archive may have at most `mostInArchive` bytes, because a few bytes there can
/// stand for any number.
Result<std::string> bytesOfFile(const std::string& file, std::size_t mostInArchive = std::size_t{256} << 20);

/// Returns the file of a texture that a model of a CDB asks for and that is not where it says: the level W
/// nearest to the one in its name, the finer one of two, from the folder that it names or from the archives
/// (301) of the model's cell, whatever tile its name has; else from the same place in the versions that the
/// model's root replaces. Returns none for other names.
std::optional<std::string> cdbTexture(const std::string& asked, const std::string& model);

}  // namespace trimtab::terrain
