#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trimtab/units/result.h"

namespace trimtab {

/// Cells of one row. Cells in which quotes stand doubled are views into `unescaped`.
struct DelimitedCells {
  std::vector<std::string_view> cells;
  std::deque<std::string> unescaped;
};

/// Reads a table of text with a header, row by row, whoever wrote it: UTF-8, or UTF-16 with a byte order
/// mark; commas, semicolons, tabs, bars or blanks between cells; decimal points or commas; cells in quotes
/// (RFC 4180); CR, LF or both; comment lines that begin with # or //; delimiters behind the last cell. It
/// finds from the header and the rows what the file does not say, and notes a reading that is not the usual
/// one. The text must live as long as its reader; cells live as long as their row.
class DelimitedText {
 public:
  DelimitedText(std::string_view text, std::string where) : text_(text), where_(std::move(where)) {}
  DelimitedText(const DelimitedText&) = delete;
  DelimitedText& operator=(const DelimitedText&) = delete;

  /// Reads up to the header. Returns false if there is none or if two readings fit; an error says why.
  bool open(Findings& findings);

  /// The names of the columns; an empty one is a column without a name. If the file has no header, they are
  /// "#1", "#2" and so on.
  const std::vector<std::string>& header() const { return header_; }
  bool hasHeader() const { return hasHeader_; }
  const std::string& file() const { return where_; }
  std::string headerPlace() const { return where_ + ':' + std::to_string(headerLine_); }
  /// Says how the table begins, for a refusal: the names of its columns and the cells of the first row.
  std::string beginning() const;

  /// Goes to the next row. Returns false at the end. All rows together take time linear in the text.
  bool nextRow();
  /// Reports whether the row has as many cells as the header; if not, nothing says which cell is which.
  bool rowFits() const { return row_.cells.size() == header_.size(); }
  const std::vector<std::string_view>& cells() const { return row_.cells; }
  /// The line on which the row begins, from 1.
  std::size_t line() const { return rowLine_; }
  std::string place() const { return where_ + ':' + std::to_string(rowLine_); }
  /// Reports whether the last row ended with its line; if not, the file may be cut inside its last number.
  bool lastLineEnds() const { return lastLineEnds_; }

  /// Reads a cell as a number with the table's decimal mark; "nan" and "inf" are read as such.
  std::optional<double> number(std::string_view cell) const;

 private:
  struct Place {
    std::string_view text;
    std::size_t line = 0;
  };

  bool decode(Findings& findings);
  std::optional<std::string_view> nextLine();
  std::optional<std::string_view> nextContent();
  std::string_view withQuotedLines(std::string_view line);
  bool findDelimiter(std::string_view header, const std::vector<std::string_view>& sample,
                     Findings& findings);
  bool findDecimalMark(Findings& findings);
  bool namesCells(const std::vector<std::string_view>& sample, Findings& findings);
  void readHeader(std::string_view line, const Place& before, Findings& findings);

  std::string_view text_;
  std::string where_, decoded_;
  char lineEnd_ = '\n', delimiter_ = ',';
  bool decimalComma_ = false, hasHeader_ = true, lastLineEnds_ = true;
  std::size_t line_ = 0, rowLine_ = 0, headerLine_ = 0;
  std::string_view comment_;  ///< the last comment line
  std::vector<std::string> header_, firstRow_;
  DelimitedCells row_;
};

/// Returns a cell for a message: in quotes, cut where it is long, "nothing" if empty.
std::string cellText(std::string_view cell);

}  // namespace trimtab
