#include <zlib.h>

#include <algorithm>

#include "trimtab/preset/file_io.h"
#include "trimtab/terrain/scenery/scenery.h"

namespace trimtab::terrain {

namespace {

namespace fs = std::filesystem;

/// The heaviest tile known has 17 MB.
constexpr std::size_t kMostBytes = std::size_t{256} << 20;

Finding wrong(const std::string& where, std::string key, std::string expected, std::string found) {
  return {Severity::error, where, std::move(key), std::move(expected), std::move(found)};
}

struct Inflater {
  z_stream stream{};
  bool ready;

  Inflater() : ready(::inflateInit2(&stream, 16 + MAX_WBITS) == Z_OK) {}  // 16: gzip's header and sum
  ~Inflater() {
    if (ready) ::inflateEnd(&stream);
  }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
};

bool isGzip(std::string_view bytes) {
  return bytes.size() >= 2 && bytes[0] == '\x1f' && bytes[1] == '\x8b';
}

}  // namespace

Result<std::string> gunzip(std::string_view bytes, const std::string& where) {
  Inflater inflater;
  if (!inflater.ready) return wrong(where, "", "memory to unzip", "none");
  if (bytes.size() > kMostBytes)
    return wrong(where, "size", "at most " + std::to_string(kMostBytes) + " bytes",
                 std::to_string(bytes.size()));
  z_stream& z = inflater.stream;
  z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  z.avail_in = static_cast<uInt>(bytes.size());
  std::string out(std::clamp<std::size_t>(bytes.size() * 4, 1 << 14, 1 << 24), '\0');
  std::size_t filled = 0;
  for (;;) {
    if (filled == out.size()) {
      if (out.size() >= kMostBytes)
        return wrong(where + ":" + std::to_string(bytes.size() - z.avail_in), "unzipped size",
                     "at most " + std::to_string(kMostBytes) + " bytes", "more");
      out.resize(std::min(out.size() * 2, kMostBytes));
    }
    z.next_out = reinterpret_cast<Bytef*>(out.data() + filled);
    z.avail_out = static_cast<uInt>(out.size() - filled);
    const int code = ::inflate(&z, Z_NO_FLUSH);
    filled = out.size() - z.avail_out;
    const std::size_t at = bytes.size() - z.avail_in;
    if (code == Z_STREAM_END) {
      if (!isGzip(bytes.substr(at))) break;  // what follows the last member is padding
      if (::inflateReset(&z) != Z_OK) break;
    } else if (code != Z_OK && !(code == Z_BUF_ERROR && z.avail_out == 0)) {
      return wrong(where + ":" + std::to_string(at), "gzip",
                   code == Z_BUF_ERROR ? "a whole gzip stream" : "gzip data",
                   code == Z_BUF_ERROR ? "the end of the file" : (z.msg != nullptr ? z.msg : "damage"));
    }
  }
  out.resize(filled);
  return out;
}

Result<SceneryMesh> readBtg(const fs::path& file, bool withTexture) {
  std::error_code error;
  const auto status = fs::status(file, error);
  if (!fs::is_regular_file(status))
    return wrong(file.string(), "", "a file", fs::exists(status) ? "something else" : "nothing there");
  const auto bytes = readWhole(file, kMostBytes);
  if (!bytes) return bytes.findings();
  if (!isGzip(*bytes)) return parseBtg(*bytes, file.string(), withTexture);
  const auto unzipped = gunzip(*bytes, file.string());
  if (!unzipped) return unzipped.findings();
  return parseBtg(*unzipped, file.string(), withTexture);
}

}  // namespace trimtab::terrain
