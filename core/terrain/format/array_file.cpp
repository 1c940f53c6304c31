#include "array_file.h"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <fstream>

#include "trimtab/preset/file_io.h"
#include "trimtab/preset/preset.h"
#include "trimtab/terrain/format/store.h"

namespace trimtab::terrain {

namespace {

static_assert(std::endian::native == std::endian::little, "the file is little-endian");

Finding wrongFile(const std::filesystem::path& file, std::string key, std::string expected,
                  std::string found) {
  return {Severity::error, file.string(), std::move(key), std::move(expected), std::move(found)};
}

}  // namespace

Result<std::uint64_t> writeArrayFile(const std::filesystem::path& file, const ArrayFileKind& kind,
                                     std::uint32_t version, ArrayWriter writer) {
  const std::string_view body = std::string_view(writer.bytes).substr(ArrayWriter::kHeaderBytes);
  const std::uint64_t size = body.size(), sum = checksum(body);
  char* const header = writer.bytes.data();
  std::memcpy(header, kind.magic.data(), kind.magic.size());
  std::memcpy(header + 8, &version, sizeof version);
  std::memcpy(header + 12, &size, sizeof size);
  std::memcpy(header + 20, &sum, sizeof sum);
  if (auto written = writeAtomically(file, writer.bytes); !written) return written.findings();
  return sum;
}

Result<ArrayFileBody> readArrayFile(const std::filesystem::path& file, const ArrayFileKind& kind) {
  constexpr std::size_t kHeader = ArrayWriter::kHeaderBytes;
  if (const auto data = checkIsData(file); !data) return data.findings();
  std::error_code error;
  const std::uint64_t size = std::filesystem::file_size(file, error);
  if (error) return wrongFile(file, "", "a readable file", error.message());
  std::ifstream in(file, std::ios::binary);
  std::array<char, kHeader> header{};
  in.read(header.data(), kHeader);
  if (in.gcount() != kHeader || std::memcmp(header.data(), kind.magic.data(), kind.magic.size()) != 0)
    return wrongFile(file, "",
                     std::string(kind.name) + " (" + std::string(kind.magic.data(), kind.magic.size()) + ")",
                     "another file of " + std::to_string(size) + " bytes");
  ArrayFileBody body;
  std::uint64_t bodySize;
  std::memcpy(&body.version, &header[8], sizeof body.version);
  std::memcpy(&bodySize, &header[12], sizeof bodySize);
  std::memcpy(&body.sum, &header[20], sizeof body.sum);
  if (body.version < kind.oldest || body.version > kind.newest) {
    const std::string newest = std::to_string(kind.newest);
    return wrongFile(file, "version",
                     (kind.oldest == kind.newest ? newest : std::to_string(kind.oldest) + " or " + newest) +
                         " (bake the sources again)",
                     std::to_string(body.version));
  }
  if (bodySize != size - kHeader)
    return wrongFile(file, "size", std::to_string(bodySize) + " bytes after the header",
                     std::to_string(size - kHeader) + " bytes");
  body.bytes.assign(bodySize, '\0');
  in.read(body.bytes.data(), static_cast<std::streamsize>(bodySize));
  if (!in) return wrongFile(file, "", "a readable file", std::strerror(errno));
  if (const std::uint64_t found = checksum(body.bytes); found != body.sum)
    return wrongFile(file, "checksum", hexadecimal(body.sum), hexadecimal(found));
  return body;
}

Findings endFindings(const std::filesystem::path& file, const ArrayReader& reader) {
  if (!reader.failed() && reader.atEnd()) return {};
  return {wrongFile(file, "", "arrays that end with the file",
                    reader.failed() ? "one past its end" : "bytes left over")};
}

Finding faultFinding(const std::filesystem::path& file, std::string fault) {
  return wrongFile(file, std::move(fault), "numbers that agree with each other", "some that do not");
}

}  // namespace trimtab::terrain
