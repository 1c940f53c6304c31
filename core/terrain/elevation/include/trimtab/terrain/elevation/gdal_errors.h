#pragma once

#include <string>

#include "trimtab/units/result.h"

namespace trimtab::terrain {

/// While it lives, what GDAL says on this thread is kept instead of printed.
class GdalErrors {
 public:
  GdalErrors();
  ~GdalErrors();
  GdalErrors(const GdalErrors&) = delete;
  GdalErrors& operator=(const GdalErrors&) = delete;

  /// The last thing it complained of, or `otherwise`.
  std::string last(const std::string& otherwise) const;
  /// Whether it complained of more than what it only warns of.
  bool any() const;
  /// All of it as findings about a file, each text once: `worst` for what GDAL calls errors.
  void moveTo(Findings& findings, const std::string& where, Severity worst);

 private:
  struct Said {
    bool error;
    std::string text;
  };
  std::vector<Said> said_;
  friend struct GdalErrorsAccess;
};

/// Registers GDAL's drivers, once, and bounds its cache.
void useGdal();

}  // namespace trimtab::terrain
