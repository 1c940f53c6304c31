#pragma once

#include <filesystem>
#include <string>

#include "trimtab/units/result.h"

namespace trimtab::terrain {

/// Collects GDAL's messages of this thread, instead of printing them, while this object lives.
class GdalErrors {
 public:
  GdalErrors();
  ~GdalErrors();
  GdalErrors(const GdalErrors&) = delete;
  GdalErrors& operator=(const GdalErrors&) = delete;

  /// Returns GDAL's last message, or `otherwise` if there is none.
  std::string last(const std::string& otherwise) const;
  /// Tells whether GDAL reported an error, not only warnings.
  bool any() const;
  /// Appends all messages as findings about `where`, each text once, and forgets them. GDAL's errors get the
  /// severity `worst`.
  void moveTo(Findings& findings, const std::string& where, Severity worst);

 private:
  struct Said {
    bool error;
    std::string text;
  };
  std::vector<Said> said_;
  friend struct GdalErrorsAccess;
};

/// Registers GDAL's drivers, once per process, and limits its block cache.
void useGdal();

/// Tells whether a name is that of a pipe, a socket, a device or a file of the kernel, for which GDAL may
/// wait for ever.
bool neverEnds(const std::filesystem::path& file);

}  // namespace trimtab::terrain
