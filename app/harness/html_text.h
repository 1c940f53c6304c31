#pragma once

#include <string>
#include <string_view>
#include <vector>

/// The pieces that the page is written with. It is XML as well as HTML, so that anything can read it.
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
  /// `words` is what people read; `value` what the column is sorted by; `more` stands small beneath.
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
/// "1 frame", "2 frames".
std::string counted(std::size_t count, std::string_view what);
/// "1.2 MB".
std::string sizeText(std::size_t bytes);

}  // namespace trimtab::harness
