#pragma once

#include <string>
#include <string_view>
#include <vector>

/// Writes the elements of the HTML page. The page is valid XML too, so that any XML reader can parse it.
namespace trimtab::harness {

struct HtmlColumn {
  std::string label;
  std::string unit = {};
  std::string help = {};  ///< shown while the pointer rests on it
  bool number = true;
};

class HtmlTable {
 public:
  explicit HtmlTable(std::string caption, std::vector<HtmlColumn> columns);
  void row();
  void text(std::string_view words);
  /// Adds a cell that shows `words`, with `more` in small print below. The column is sorted by `value`.
  void number(double value, std::string_view words, std::string_view more = {}, const char* cls = "");
  void blank();
  std::string take();
  bool empty() const { return rows_ == 0; }

 private:
  std::string out_;
  std::size_t rows_ = 0;
};

std::string paragraph(std::string_view text, const char* cls = "");
std::string section(const char* id, std::string_view title, std::string_view body);
std::string base64(std::string_view bytes);
/// Returns words with commas between them.
std::string joined(const std::vector<std::string>& words);
/// Returns "a, b and c".
std::string enumerated(const std::vector<std::string>& words);
/// Returns a count with its noun: "1 frame", "2 frames".
std::string counted(std::size_t count, std::string_view what);
/// Returns a size for people to read, such as "1.2 MB".
std::string sizeText(std::size_t bytes);

}  // namespace trimtab::harness
