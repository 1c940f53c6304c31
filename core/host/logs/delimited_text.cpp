#include "delimited_text.h"

#include <algorithm>
#include <array>

#include "foreign_file.h"
#include "trimtab/units/number.h"
#include "trimtab/units/text.h"

namespace trimtab {
namespace {

/// Stands for any run of blanks and tabs.
constexpr char kBlank = ' ';
/// A quoted cell may go on over so many lines; beyond them its quotation mark is taken for a character, so
/// that one stray mark does not swallow the file.
constexpr int kMostLinesOfCell = 8;
constexpr std::size_t kSampleRows = 20;

Finding error(std::string place, std::string expected, std::string found) {
  return {Severity::error, std::move(place), "", std::move(expected), std::move(found)};
}

bool isBlank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

std::size_t cellEnd(std::string_view line, std::size_t from, char delimiter) {
  const std::size_t end = delimiter == kBlank ? line.find_first_of(" \t", from) : line.find(delimiter, from);
  return std::min(end, line.size());
}

std::string withoutDoubledQuotes(std::string_view cell) {
  std::string text;
  for (std::size_t i = 0; i < cell.size(); ++i) {
    text += cell[i];
    if (cell[i] == '"') ++i;
  }
  return text;
}

void split(std::string_view line, char delimiter, DelimitedCells& row) {
  row.cells.clear();
  row.unescaped.clear();
  for (std::size_t at = 0; at <= line.size();) {
    std::size_t begin = at;
    while (begin < line.size() && isBlank(line[begin]) &&
           line[begin] != (delimiter == kBlank ? 0 : delimiter))
      ++begin;
    if (delimiter == kBlank && begin == line.size()) return;
    std::size_t close = std::string_view::npos;
    bool doubled = false;
    if (begin < line.size() && line[begin] == '"') {
      close = line.find('"', begin + 1);
      while (close != std::string_view::npos && line.substr(close).starts_with("\"\"")) {
        doubled = true;
        close = line.find('"', close + 2);
      }
    }
    const bool closed = close != std::string_view::npos;
    const std::size_t end = cellEnd(line, closed ? close + 1 : begin, delimiter);
    std::string_view cell = trimmed(line.substr(begin, end - begin));
    // What follows the closing mark belongs to no quoted cell; then the marks are characters.
    if (closed && trimmed(line.substr(close + 1, end - close - 1)).empty()) {
      cell = line.substr(begin + 1, close - begin - 1);
      if (doubled) cell = row.unescaped.emplace_back(withoutDoubledQuotes(cell));
    }
    row.cells.push_back(cell);
    at = end + 1;
  }
}

DelimitedCells cellsOf(std::string_view line, char delimiter) {
  DelimitedCells row;
  split(line, delimiter, row);
  while (row.cells.size() > 1 && row.cells.back().empty()) row.cells.pop_back();
  return row;
}

enum class Mark { none, point, comma, comma_or_thousands };

/// Finds the decimal mark of a number; nothing if the cell is no number.
std::optional<Mark> markOf(std::string_view cell) {
  if (cell.starts_with('+') || cell.starts_with('-')) cell.remove_prefix(1);
  const auto digits = [&cell] {
    const std::size_t count = std::min(cell.find_first_not_of("0123456789"), cell.size());
    cell.remove_prefix(count);
    return count;
  };
  const bool zero = cell.starts_with('0');
  const std::size_t before = digits();
  Mark mark = Mark::none;
  std::size_t after = 0;
  if (cell.starts_with('.') || cell.starts_with(',')) {
    mark = cell.front() == '.' ? Mark::point : Mark::comma;
    cell.remove_prefix(1);
    after = digits();
  }
  if (before + after == 0) return std::nullopt;
  if (mark == Mark::comma && after == 3 && !zero && before > 0 && before < 4 && cell.empty())
    mark = Mark::comma_or_thousands;
  if (cell.starts_with('e') || cell.starts_with('E')) {
    cell.remove_prefix(1);
    if (cell.starts_with('+') || cell.starts_with('-')) cell.remove_prefix(1);
    if (digits() == 0) return std::nullopt;
  }
  if (!cell.empty()) return std::nullopt;
  return mark;
}

std::size_t numbersIn(const std::vector<std::string_view>& cells) {
  return static_cast<std::size_t>(std::count_if(
      cells.begin(), cells.end(), [](std::string_view cell) { return markOf(cell).has_value(); }));
}

const char* nameOf(char delimiter) {
  switch (delimiter) {
    case ';':
      return "semicolons";
    case '\t':
      return "tabs";
    case '|':
      return "bars";
    case kBlank:
      return "blanks";
    default:
      return "commas";
  }
}

void appendUtf8(std::string& text, char32_t c) {
  const auto add = [&text](char32_t byte) { text += static_cast<char>(static_cast<unsigned char>(byte)); };
  if (c < 0x80) return add(c);
  if (c < 0x800) {
    add(0xc0 | c >> 6);
  } else if (c < 0x10000) {
    add(0xe0 | c >> 12);
    add(0x80 | (c >> 6 & 0x3f));
  } else {
    add(0xf0 | c >> 18);
    add(0x80 | (c >> 12 & 0x3f));
    add(0x80 | (c >> 6 & 0x3f));
  }
  add(0x80 | (c & 0x3f));
}

std::string fromUtf16(std::string_view bytes, bool bigEndian) {
  const auto unit = [&](std::size_t i) {
    const auto a = static_cast<unsigned char>(bytes[i]), b = static_cast<unsigned char>(bytes[i + 1]);
    return static_cast<char32_t>(bigEndian ? a << 8 | b : b << 8 | a);
  };
  std::string text;
  text.reserve(bytes.size() / 2);
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    char32_t c = unit(i);
    if (c >= 0xd800 && c < 0xdc00 && i + 3 < bytes.size() && unit(i + 2) >= 0xdc00 && unit(i + 2) < 0xe000) {
      c = 0x10000 + ((c - 0xd800) << 10) + (unit(i + 2) - 0xdc00);
      i += 2;
    }
    appendUtf8(text, c >= 0xd800 && c < 0xe000 ? 0xfffd : c);
  }
  return text;
}

}  // namespace

std::string cellText(std::string_view cell) {
  return cell.empty() ? "nothing" : '"' + std::string(cell.substr(0, 40)) + '"';
}

bool DelimitedText::decode(Findings& findings) {
  if (text_.starts_with("\xff\xfe") || text_.starts_with("\xfe\xff")) {
    decoded_ = fromUtf16(text_.substr(2), text_.front() == '\xfe');
    text_ = decoded_;
  }
  text_ = withoutByteOrderMark(text_);
  if (const std::string what = notATable(text_); !what.empty()) {
    findings.push_back(error(where_, "a table of text with a header", what + ": export it as CSV"));
    return false;
  }
  if (text_.substr(0, 4096).find('\0') != std::string_view::npos) {
    findings.push_back(
        error(where_, "text: a CSV file with a header",
              isUtf16(text_) ? "UTF-16 without a byte order mark: save the file as UTF-8" : "binary data"));
    return false;
  }
  if (text_.find('\n') == std::string_view::npos && text_.find('\r') != std::string_view::npos)
    lineEnd_ = '\r';
  return true;
}

std::optional<std::string_view> DelimitedText::nextLine() {
  if (text_.empty()) return std::nullopt;
  ++line_;
  const std::size_t end = text_.find(lineEnd_);
  std::string_view line = text_.substr(0, end);
  text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + 1);
  while (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

/// Returns the next line that is neither empty nor a comment.
std::optional<std::string_view> DelimitedText::nextContent() {
  while (const auto line = nextLine()) {
    const std::string_view content = trimmed(*line);
    const bool comment = content.starts_with('#') || content.starts_with("//");
    if (comment) comment_ = content;
    if (comment || content.empty()) continue;
    lastLineEnds_ = !text_.empty() || line->data() + line->size() != text_.data();
    return line;
  }
  return std::nullopt;
}

/// Returns the line with those after it into which a quoted cell goes on.
std::string_view DelimitedText::withQuotedLines(std::string_view line) {
  if (line.find('"') == std::string_view::npos) return line;
  bool quoted = false, begins = true, closed = false;
  const auto scan = [&](std::string_view part) {
    for (const char c : part) {
      if (quoted) {
        closed = c == '"';
        quoted = !closed;
      } else {
        quoted = c == '"' && (begins || closed);
        closed = false;
        begins = c == delimiter_ || (begins && isBlank(c)) || (delimiter_ == kBlank && isBlank(c));
      }
    }
  };
  scan(line);
  const Place before{text_, line_};
  for (int lines = 1; quoted && lines < kMostLinesOfCell; ++lines) {
    const auto more = nextLine();
    if (!more) break;
    scan(*more);
    if (!quoted) return {line.data(), static_cast<std::size_t>(more->data() + more->size() - line.data())};
  }
  text_ = before.text;
  line_ = before.line;
  return line;
}

bool DelimitedText::findDelimiter(std::string_view header, const std::vector<std::string_view>& sample,
                                  Findings& findings) {
  struct Candidate {
    char delimiter;
    std::size_t columns, rowsThatFit = 0, numbers = 0;
  };
  std::vector<Candidate> candidates;
  for (const char delimiter : {',', ';', '\t', '|'}) {
    const std::size_t columns = cellsOf(header, delimiter).cells.size();
    if (columns < 2) continue;
    Candidate& candidate = candidates.emplace_back(Candidate{delimiter, columns});
    for (const std::string_view line : sample) {
      const DelimitedCells row = cellsOf(line, delimiter);
      candidate.rowsThatFit += row.cells.size() == columns;
      candidate.numbers += numbersIn(row.cells);
    }
  }
  if (candidates.empty()) {
    delimiter_ = cellsOf(header, kBlank).cells.size() > 1 ? kBlank : ',';
    return true;
  }
  const auto better = [](const Candidate& a, const Candidate& b) {
    return std::array{a.rowsThatFit, a.numbers, a.columns} > std::array{b.rowsThatFit, b.numbers, b.columns};
  };
  std::stable_sort(candidates.begin(), candidates.end(), better);
  delimiter_ = candidates[0].delimiter;
  if (candidates.size() < 2 || better(candidates[0], candidates[1])) return true;
  findings.push_back(error(headerPlace(), "one delimiter between columns",
                           std::string(nameOf(delimiter_)) + " and " + nameOf(candidates[1].delimiter) +
                               ", which fit alike: write the file with one of them"));
  return false;
}

/// Commas may be decimal marks wherever they do not separate cells.
bool DelimitedText::findDecimalMark(Findings& findings) {
  if (delimiter_ == ',') return true;
  const Place begin{text_, line_};
  std::string point, comma, perhaps;
  while (nextRow())
    for (const std::string_view cell : cells()) {
      const auto mark = markOf(cell);
      if (!mark || *mark == Mark::none) continue;
      std::string& seen = *mark == Mark::point ? point : *mark == Mark::comma ? comma : perhaps;
      if (seen.empty()) seen = cellText(cell) + " in line " + std::to_string(rowLine_);
    }
  text_ = begin.text;
  line_ = begin.line;
  if (comma.empty() && perhaps.empty()) return true;
  if (!point.empty() && !comma.empty()) {
    findings.push_back(error(where_, "one decimal mark",
                             point + " and " + comma + ": write all numbers with a decimal point"));
    return false;
  }
  // 1,234 beside 0.5 can only be grouped thousands; they are no number here, and their row says so.
  if (!point.empty()) return true;
  if (comma.empty()) {
    findings.push_back(error(where_, "numbers with a decimal point",
                             perhaps + ": the comma may be a decimal mark or group thousands; write the "
                                       "numbers with a decimal point, or without groups"));
    return false;
  }
  decimalComma_ = true;
  findings.push_back(
      {Severity::note, where_, "", "",
       std::string("numbers have a decimal comma and ") + nameOf(delimiter_) + " between them"});
  return true;
}

/// A table that begins with numbers has its header in the comment above it or not at all.
void DelimitedText::readHeader(std::string_view line, const Place& before, Findings& findings) {
  split(line, delimiter_, row_);
  while (row_.cells.size() > 1 && row_.cells.back().empty()) row_.cells.pop_back();
  if (2 * numbersIn(row_.cells) < row_.cells.size() || row_.cells.empty()) {
    header_.assign(row_.cells.begin(), row_.cells.end());
    return;
  }
  const std::size_t columns = row_.cells.size();
  text_ = before.text;
  line_ = before.line;
  std::string_view comment = comment_;
  while (comment.starts_with('#') || comment.starts_with('/')) comment.remove_prefix(1);
  const DelimitedCells names = cellsOf(trimmed(comment), delimiter_);
  if (names.cells.size() == columns && numbersIn(names.cells) == 0) {
    header_.assign(names.cells.begin(), names.cells.end());
    findings.push_back({Severity::note, where_, "", "", "the comment above the first row names the columns"});
    return;
  }
  hasHeader_ = false;
  for (std::size_t i = 1; i <= columns; ++i) header_.push_back('#' + std::to_string(i));
}

/// Refuses a header that names fewer columns than all rows have: nothing says which of them it leaves out.
bool DelimitedText::namesCells(const std::vector<std::string_view>& sample, Findings& findings) {
  std::size_t most = 0;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    const std::size_t cells = cellsOf(sample[i], delimiter_).cells.size();
    if (cells <= header_.size() || (i > 0 && cells != most)) return true;
    most = cells;
  }
  if (most == 0) return true;
  findings.push_back(
      error(headerPlace(), "a name for each of the " + std::to_string(most) + " cells of a row",
            std::to_string(header_.size()) + std::string(" names: name the other columns, too") +
                (delimiter_ == ',' ? ", or separate columns by semicolons if commas are decimal" : "")));
  return false;
}

bool DelimitedText::open(Findings& findings) {
  if (!decode(findings)) return false;
  Place before{text_, line_};
  auto line = nextContent();
  // Excel's hint; what it says shows in the rows, too.
  if (line && line->size() == 5 && line->starts_with("sep=")) {
    before = {text_, line_};
    line = nextContent();
  }
  headerLine_ = line_;
  if (!line) {
    findings.push_back(error(headerPlace(), "a header that names its columns", "an empty file"));
    return false;
  }
  const Place after{text_, line_};
  const bool ends = lastLineEnds_;
  const std::string_view comment = comment_;
  std::vector<std::string_view> sample;
  while (sample.size() < kSampleRows) {
    const auto row = nextContent();
    if (!row) break;
    sample.push_back(*row);
  }
  text_ = after.text;
  line_ = after.line;
  lastLineEnds_ = ends;
  comment_ = comment;
  if (!findDelimiter(*line, sample, findings)) return false;
  line = withQuotedLines(*line);
  readHeader(*line, before, findings);
  if (!namesCells(sample, findings)) return false;
  const Place begin{text_, line_};
  if (nextRow()) firstRow_.assign(cells().begin(), cells().end());
  text_ = begin.text;
  line_ = begin.line;
  return findDecimalMark(findings);
}

std::string DelimitedText::beginning() const {
  static constexpr std::size_t kMost = 12;
  const auto list = [](const std::vector<std::string>& cells) {
    std::string text;
    for (std::size_t i = 0; i < std::min(cells.size(), kMost); ++i)
      text += (i > 0 ? ", " : "") + (cells[i].empty() ? "\"\"" : cellText(cells[i]));
    return text + (cells.size() > kMost ? ", ..." : "");
  };
  return (hasHeader_ ? "the columns " + list(header_)
                     : "no header over " + std::to_string(header_.size()) +
                           " columns, which a map names by number, as latitude_deg=#1") +
         (firstRow_.empty() ? " and no row" : "; the first row is " + list(firstRow_));
}

bool DelimitedText::nextRow() {
  const auto line = nextContent();
  if (!line) return false;
  rowLine_ = line_;
  split(withQuotedLines(*line), delimiter_, row_);
  auto& cells = row_.cells;
  while (cells.size() > header_.size() && cells.back().empty()) cells.pop_back();
  return true;
}

std::optional<double> DelimitedText::number(std::string_view cell) const {
  cell = trimmed(cell);
  if (cell.starts_with('+')) cell.remove_prefix(1);
  if (!decimalComma_ || cell.find(',') == std::string_view::npos) return readNumber(cell);
  std::string text(cell);
  std::replace(text.begin(), text.end(), ',', '.');
  return readNumber(text);
}

}  // namespace trimtab
