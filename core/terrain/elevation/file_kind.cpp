#include "file_kind.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string_view>

namespace trimtab::terrain {

namespace fs = std::filesystem;

namespace {

std::string lowerCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string extensionOf(const fs::path& file) {
  return lowerCase(file.extension().string());
}

/// A format that many have and that this GDAL may have no driver for.
struct Format {
  const char* extension;
  std::string_view begins;  ///< empty: the name alone says it
  const char* name;
  const char* instead;
};
using namespace std::string_view_literals;
constexpr Format kFormats[] = {
    {".sid", "msid"sv, "a MrSID image", "export it as GeoTIFF"},
    {".ecw", "\x65\x02"sv, "an ECW image", "export it as GeoTIFF"},
    {".ecw", {}, "an ECW image", "export it as GeoTIFF"},
    {".dsf", "XPLNEDSF"sv, "X-Plane scenery (DSF)", "export its elevation with DSFTool, or take its source"},
    {".dsf", "7z\xbc\xaf\x27\x1c"sv, "X-Plane scenery (DSF), packed with 7-Zip",
     "unpack it and export its elevation with DSFTool, or take its source"},
    {".las", "LASF"sv, "a cloud of points (LAS)", "make a grid of it, with PDAL for instance"},
    {".laz", "LASF"sv, "a cloud of points (LAZ)", "make a grid of it, with PDAL for instance"},
    {".dwg", "AC10"sv, "a drawing (DWG)", "export its surface as GeoTIFF"},
};

constexpr std::array kRasterExtensions{".tif", ".tiff", ".hgt", ".dt0", ".dt1", ".dt2", ".asc", ".dem",
                                       ".img", ".bil",  ".bip", ".bsq", ".flt", ".nc",  ".hdf", ".h5",
                                       ".he5", ".jp2",  ".vrt", ".adf", ".grd", ".ter", ".toc", ".gpkg"};

std::string headOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string head(512, '\0');
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(std::max<std::streamsize>(in.gcount(), 0)));
  return head;
}

const Format* formatOf(const fs::path& file, const std::string& head) {
  const auto* const format = std::find_if(std::begin(kFormats), std::end(kFormats), [&](const Format& f) {
    return f.begins.empty() ? extensionOf(file) == f.extension : head.starts_with(f.begins);
  });
  return format == std::end(kFormats) ? nullptr : format;
}

bool isText(const std::string& head) {
  return std::none_of(head.begin(), head.end(), [](char c) {
    return static_cast<unsigned char>(c) < 32 && std::strchr("\t\n\v\f\r", c) == nullptr;
  });
}

/// Names the kind of text by its first letters.
std::string textKind(const std::string& head) {
  std::string start = lowerCase(head.substr(0, 100));
  start.erase(0, std::min(start.find_first_not_of("\xef\xbb\xbf \t\r\n"), start.size()));
  if (start.starts_with("<!doctype html") || start.starts_with("<html") || start.starts_with("<head"))
    return "a web page, HTML text";
  if (start.starts_with("<?xml")) return "XML text";
  if (start.starts_with("{") || start.starts_with("[{")) return "JSON text";
  return "text";
}

/// The posts of an .hgt are the square root of half its bytes.
std::string hgtSize(const fs::path& file) {
  std::error_code error;
  const auto bytes = fs::file_size(file, error);
  if (error) return {};
  const auto side = static_cast<std::uintmax_t>(std::llround(std::sqrt(static_cast<double>(bytes) / 2)));
  const std::string size = "an .hgt of " + std::to_string(bytes) + " bytes, ";
  constexpr const char* kKnown = "1201 x 1201 posts have 2884802 bytes and 3601 x 3601 have 25934402";
  if (side * side * 2 != bytes)
    return size + "which is no square of posts (" + kKnown + "): cut off, or packed";
  return size + std::to_string(side) + " x " + std::to_string(side) + " posts, which GDAL does not read (" +
         kKnown + "): rename it to .bil and give it a header, or take another source";
}

/// Names what the first bytes say; empty if they say nothing.
std::string byFirstBytes(const fs::path& file, const std::string& head) {
  if (head.starts_with("\x1f\x8b") || head.starts_with("PK\x03\x04") ||
      head.starts_with("7z\xbc\xaf\x27\x1c"))
    return "a packed file, to be unpacked first";
  if (head.starts_with("\xd4\xc3\xb2\xa1") || head.starts_with("\xa1\xb2\xc3\xd4"))
    return "a capture of packets";
  if (head.starts_with("%PDF")) return "a PDF page";
  if (isText(head)) return textKind(head);
  return extensionOf(file) == ".hgt" ? hgtSize(file) : "";
}

}  // namespace

bool isRasterName(const fs::path& file) {
  const std::string extension = extensionOf(file);
  return std::any_of(kRasterExtensions.begin(), kRasterExtensions.end(),
                     [&](const char* known) { return extension == known; }) ||
         std::any_of(std::begin(kFormats), std::end(kFormats),
                     [&](const Format& format) { return extension == format.extension; });
}

std::string whatItIs(const fs::path& file, const GdalErrors& errors) {
  const std::string head = headOf(file);
  if (head.empty()) return "an empty file";
  if (const Format* format = formatOf(file, head))
    return std::string(format->name) + ", for which this GDAL has no driver: " + format->instead;
  const std::string reason = errors.last("GDAL gives no reason");
  const bool unknown = reason.find("not recognized") != std::string::npos || errors.last("").empty();
  const std::string kind = byFirstBytes(file, head);
  if (kind.empty()) return unknown ? "data that is not recognized" : reason;
  if (kind.starts_with("an .hgt")) return kind;
  const std::string more = isText(head) && isRasterName(file) && !kind.starts_with("text")
                               ? ": what a server sent in place of the file"
                               : "";
  return kind + (unknown ? ", not recognized as a raster" : ", not recognized as a raster (" + reason + ")") +
         more;
}

std::string kindOf(const fs::path& file) {
  const std::string head = headOf(file);
  if (head.empty()) return "empty";
  if (const Format* format = formatOf(file, head)) return format->name;
  const std::string kind = byFirstBytes(file, head);
  return kind.empty() ? "not recognized" : kind;
}

}  // namespace trimtab::terrain
