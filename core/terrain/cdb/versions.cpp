#include "versions.h"

#include <cpl_error.h>
#include <cpl_minixml.h>

#include <algorithm>
#include <memory>

namespace trimtab::terrain {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostVersions = 256;

using CdbXml = std::unique_ptr<CPLXMLNode, void (*)(CPLXMLNode*)>;

/// Reads a file of Metadata; null, with a warning, if it is damaged, and null if there is none.
CdbXml metadataOf(const fs::path& file, FindingList& findings) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return {nullptr, CPLDestroyXMLNode};
  CPLPushErrorHandler(CPLQuietErrorHandler);
  CPLErrorReset();
  CdbXml xml(CPLParseXMLFile(file.c_str()), CPLDestroyXMLNode);
  const std::string why = CPLGetLastErrorMsg();
  CPLPopErrorHandler();
  if (!xml) {
    findings.add({Severity::warning, file.string(), "", "XML that says which versions there are",
                  why.empty() ? "something else" : why});
    return xml;
  }
  CPLStripXMLNamespace(xml.get(), nullptr, TRUE);
  return xml;
}

/// Paths of other machines have backslashes; relative ones count from the root.
fs::path versionFolder(const fs::path& root, std::string name) {
  std::replace(name.begin(), name.end(), '\\', '/');
  const fs::path folder(name);
  return (folder.is_absolute() ? folder : root / folder).lexically_normal();
}

bool holdsData(const fs::path& folder) {
  std::error_code error;
  return fs::is_directory(folder / "Tiles", error) || fs::is_directory(folder / "GTModel", error);
}

bool isKnown(const std::vector<fs::path>& versions, const fs::path& folder) {
  return std::any_of(versions.begin(), versions.end(), [&](const fs::path& version) {
    std::error_code error;
    return fs::equivalent(version, folder, error);
  });
}

void missing(const fs::path& file, const std::string& name, FindingList& findings) {
  findings.add({Severity::warning, file.string(), "version", "a folder with Tiles or GTModel",
                name + ", where there is none: left out"});
}

}  // namespace

std::vector<fs::path> cdbVersions(const fs::path& root, FindingList& findings) {
  std::vector<fs::path> versions;
  const fs::path configuration = root / "Metadata" / "Configuration.xml";
  if (const CdbXml xml = metadataOf(configuration, findings)) {
    const CPLXMLNode* const list = CPLGetXMLNode(xml.get(), "=Configuration");
    for (const CPLXMLNode* node = list ? list->psChild : nullptr; node; node = node->psNext) {
      const char* const name = CPLGetXMLValue(node, "Folder.path", nullptr);
      if (node->eType != CXT_Element || std::string_view(node->pszValue) != "Version" || !name) continue;
      const fs::path folder = versionFolder(root, name);
      if (!holdsData(folder))
        missing(configuration, name, findings);
      else if (!isKnown(versions, folder) && versions.size() < kMostVersions)
        versions.push_back(folder);
    }
    if (!isKnown(versions, root)) versions.insert(versions.begin(), root);
    return versions;
  }
  versions.push_back(root);
  for (fs::path at = root; versions.size() < kMostVersions;) {
    const fs::path file = at / "Metadata" / "Version.xml";
    const CdbXml xml = metadataOf(file, findings);
    const char* const name =
        xml ? CPLGetXMLValue(xml.get(), "=Version.PreviousIncrementalRootDirectory.name", nullptr) : nullptr;
    if (!name || !*name) break;
    const fs::path folder = versionFolder(at, name);
    if (!holdsData(folder)) {
      missing(file, name, findings);
      break;
    }
    if (isKnown(versions, folder)) break;
    versions.push_back(at = folder);
  }
  return versions;
}

}  // namespace trimtab::terrain
