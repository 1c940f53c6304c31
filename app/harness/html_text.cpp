#include "html_text.h"

#include <charconv>
#include <cmath>
#include <cstdint>

#include "app/plot/svg.h"

namespace trimtab::harness {

using plot::escaped;

namespace {

constexpr std::size_t kOneLine = 30;  ///< characters that a cell does not break

}  // namespace

HtmlTable::HtmlTable(std::string caption, std::vector<HtmlColumn> columns) {
  out_ = "<div class=\"scroll\"><table>\n<caption>" + escaped(caption) + "</caption>\n<thead><tr>";
  for (const HtmlColumn& column : columns) {
    out_ += column.number ? "<th scope=\"col\" class=\"n\"" : "<th scope=\"col\"";
    if (!column.help.empty()) out_ += " title=\"" + escaped(column.help) + '"';
    out_ += '>' + escaped(column.label);
    if (!column.unit.empty()) out_ += "<small>" + escaped(column.unit) + "</small>";
    out_ += "</th>";
  }
  out_ += "</tr></thead>\n<tbody>\n";
}

void HtmlTable::row() {
  if (rows_++ > 0) out_ += "</tr>\n";
  out_ += "<tr>";
}

void HtmlTable::text(std::string_view words) {
  out_ += words.size() <= kOneLine ? "<td class=\"t\">" : "<td>";
  out_ += escaped(words) + "</td>";
}

void HtmlTable::number(double value, std::string_view words, std::string_view more, const char* cls) {
  if (std::isnan(value)) return blank();
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  out_ += "<td class=\"n";
  if (*cls != 0) out_ += std::string(" ") + cls;
  out_ += "\" data-v=\"" + std::string(digits, end) + "\">" + escaped(words);
  if (!more.empty()) out_ += "<small>" + escaped(more) + "</small>";
  out_ += "</td>";
}

void HtmlTable::blank() {
  out_ += "<td class=\"n\"></td>";
}

std::string HtmlTable::take() {
  if (rows_ > 0) out_ += "</tr>\n";
  return std::move(out_) + "</tbody></table></div>\n";
}

std::string paragraph(std::string_view text, const char* cls) {
  return (*cls != 0 ? std::string("<p class=\"") + cls + "\">" : std::string("<p>")) + escaped(text) +
         "</p>\n";
}

std::string section(const char* id, std::string_view title, std::string_view body) {
  return std::string("<section id=\"") + id + "\">\n<h2>" + escaped(title) + "</h2>\n" + std::string(body) +
         "</section>\n";
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) -> std::uint32_t {
      return i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0u;
    };
    const std::uint32_t three = byte(0) << 16 | byte(1) << 8 | byte(2);
    for (std::size_t k = 0; k < 4; ++k)
      out += i + k <= bytes.size() ? kDigits[three >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string enumerated(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 == words.size() ? " and " : ", ") + words[i];
  return text;
}

std::string counted(std::size_t count, std::string_view what) {
  return std::to_string(count) + ' ' + std::string(what) + (count == 1 ? "" : "s");
}

std::string sizeText(std::size_t bytes) {
  const double size = static_cast<double>(bytes);
  return size < 1e6 ? plot::decimal(std::ceil(size / 1e3), 0) + " kB" : plot::decimal(size / 1e6, 1) + " MB";
}

}  // namespace trimtab::harness
