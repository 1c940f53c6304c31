#include "trimtab/terrain/elevation/gdal_errors.h"

#include <cpl_error.h>
#include <gdal_priv.h>

#include <algorithm>
#include <mutex>

#include "trimtab/preset/file_io.h"

namespace trimtab::terrain {

struct GdalErrorsAccess {
  static void CPL_STDCALL say(CPLErr kind, CPLErrorNum, const char* text) {
    auto* errors = static_cast<GdalErrors*>(CPLGetErrorHandlerUserData());
    if (kind == CE_Debug || kind == CE_None || errors == nullptr) return;
    // One line each: some of its texts have several.
    std::string line(text);
    std::replace(line.begin(), line.end(), '\n', ' ');
    while (!line.empty() && line.back() == ' ') line.pop_back();
    const GdalErrors::Said said{kind != CE_Warning, line};
    const bool known = std::any_of(errors->said_.begin(), errors->said_.end(),
                                   [&](const auto& s) { return s.text == said.text; });
    if (!known && errors->said_.size() < 20) errors->said_.push_back(said);
  }
};

GdalErrors::GdalErrors() {
  CPLPushErrorHandlerEx(&GdalErrorsAccess::say, this);
}
GdalErrors::~GdalErrors() {
  CPLPopErrorHandler();
}

std::string GdalErrors::last(const std::string& otherwise) const {
  return said_.empty() ? otherwise : said_.back().text;
}

bool GdalErrors::any() const {
  return std::any_of(said_.begin(), said_.end(), [](const Said& said) { return said.error; });
}

void GdalErrors::moveTo(Findings& findings, const std::string& where, Severity worst) {
  for (const Said& said : said_)
    findings.push_back(
        {said.error ? worst : Severity::note, where, "", "a file that GDAL reads without remark", said.text});
  said_.clear();
}

void useGdal() {
  static std::once_flag once;
  std::call_once(once, [] {
    GDALAllRegister();
    // Its own choice is a share of the machine's memory.
    if (CPLGetConfigOption("GDAL_CACHEMAX", nullptr) == nullptr) GDALSetCacheMax64(GIntBig{128} << 20);
  });
}

bool neverEnds(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  return is_fifo(status) || is_socket(status) || is_character_file(status) || !checkIsData(file);
}

}  // namespace trimtab::terrain
