#include "svg.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

namespace trimtab::plot {
namespace {

/// Okabe and Ito's colours, told apart by the colour-blind too, and what is legible on them.
struct Colour {
  const char* hex;
  const char* text;
};
constexpr std::array<Colour, 6> kColours{{{"#0072b2", "white"},
                                          {"#d55e00", "white"},
                                          {"#009e73", "white"},
                                          {"#cc79a7", "black"},
                                          {"#e69f00", "black"},
                                          {"#56b4e9", "black"}}};

std::size_t colourIndex(int look) {
  return static_cast<std::size_t>(std::max(look, 0)) % kColours.size();
}

std::string point(double x, double y) {
  return decimal(x, 1) + ' ' + decimal(y, 1);
}

/// One character of UTF-8 at `at`; 0 bytes where there is none.
struct Character {
  std::uint32_t code = 0;
  std::size_t bytes = 0;
};
Character characterAt(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t first = byte(at);
  if (first < 0x80) return {first, 1};
  const std::size_t length = first >= 0xf0 && first < 0xf5 ? 4 : first >= 0xe0 ? 3 : first >= 0xc2 ? 2 : 0;
  if (length == 0 || first >= 0xf5 || at + length > text.size()) return {};
  std::uint32_t code = first & (0xffu >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(at + i) & 0xc0) != 0x80) return {};
    code = code << 6 | (byte(at + i) & 0x3fu);
  }
  constexpr std::array<std::uint32_t, 5> kSmallest{0, 0, 0x80, 0x800, 0x10000};
  if (code < kSmallest[length] || code > 0x10ffff) return {};
  return {code, length};
}

bool isXml(std::uint32_t code) {
  return code == '\t' || code == '\n' || code == '\r' || (code >= 0x20 && code < 0x7f) ||
         (code >= 0xa0 && code < 0xd800) || (code >= 0xe000 && code < 0xfffe) || code >= 0x10000;
}

std::size_t countCharacters(std::string_view utf8) {
  return static_cast<std::size_t>(std::count_if(
      utf8.begin(), utf8.end(), [](char c) { return (static_cast<std::uint8_t>(c) & 0xc0) != 0x80; }));
}

/// The first `count` characters.
std::string_view beginning(std::string_view utf8, std::size_t count) {
  std::size_t at = 0;
  while (at < utf8.size() && count > 0) {
    ++at;
    while (at < utf8.size() && (static_cast<std::uint8_t>(utf8[at]) & 0xc0) == 0x80) ++at;
    --count;
  }
  return utf8.substr(0, at);
}

bool isBare(const Key& key) {
  return key.colour < 0 && key.shape < 0 && !key.line;
}

/// Returns the width as a share of the text's size, about that of common sans-serif fonts.
double characterWidth(std::string_view character) {
  const char c = character.size() == 1 ? character[0] : 'n';
  if (std::string_view("ijl.,:;'|! ftrI()[]-").find(c) != std::string_view::npos) return 0.4;
  if (std::string_view("mwMW@%").find(c) != std::string_view::npos) return 0.93;
  return c >= 'A' && c <= 'Z' ? 0.7 : 0.61;
}

}  // namespace

std::string decimal(double value, int decimals) {
  char text[400];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, decimals).ptr;
  std::string out(text, end);
  if (out.find('.') != std::string::npos) {
    out.erase(out.find_last_not_of('0') + 1);
    if (out.back() == '.') out.pop_back();
  }
  return out == "-0" ? "0" : out;
}

std::string tickText(double value) {
  const double size = std::abs(value);
  if (size >= 1e12 || (size > 0 && size < 1e-3)) {
    const double power = std::floor(std::log10(size) + 1e-9);
    return decimal(value / std::pow(10, power), 2) + 'e' + decimal(power, 0);
  }
  if (size >= 1e6) return decimal(value / 1e6, 3) + "M";
  if (size >= 1e4) return decimal(value / 1e3, 3) + "k";
  return decimal(value, 6);
}

std::string escaped(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    const Character c = characterAt(text, at);
    if (c.bytes == 0 || !isXml(c.code))
      out += "\xef\xbf\xbd";
    else if (c.code == '&')
      out += "&amp;";
    else if (c.code == '<')
      out += "&lt;";
    else if (c.code == '>')
      out += "&gt;";
    else if (c.code == '"')
      out += "&quot;";
    else if (c.code == '\'')
      out += "&#39;";
    else
      out += text.substr(at, c.bytes);
    at += std::max<std::size_t>(c.bytes, 1);
  }
  return out;
}

double textWidthPx(std::string_view utf8, double sizePx) {
  double width = 0;
  for (std::size_t at = 0; at < utf8.size();) {
    const std::size_t bytes = beginning(utf8.substr(at), 1).size();
    width += characterWidth(utf8.substr(at, bytes));
    at += bytes;
  }
  return width * sizePx;
}

std::string shortened(std::string_view utf8, double widthPx, double sizePx) {
  if (textWidthPx(utf8, sizePx) <= widthPx) return std::string(utf8);
  const std::size_t all = countCharacters(utf8);
  std::string text;
  for (std::size_t kept = all - 1; kept > 1; --kept) {
    const std::size_t tail = kept / 3;
    text = std::string(beginning(utf8, kept - tail)) + "\xe2\x80\xa6" +
           std::string(utf8.substr(beginning(utf8, all - tail).size()));
    if (textWidthPx(text, sizePx) <= widthPx) break;
  }
  return text;
}

std::string dashOf(int look) {
  constexpr std::array<const char*, 4> kDashes{"", "7 3", "2 3", "9 3 2 3"};
  return kDashes[static_cast<std::size_t>(std::max(look, 0)) % kDashes.size()];
}

void Svg::text(double x, double y, const char* anchor, std::string_view words, std::string_view more,
               const char* cls) {
  out_ += "<text class=\"" + std::string(cls) + "\" x=\"" + decimal(x, 1) + "\" y=\"" + decimal(y, 1) +
          "\" text-anchor=\"" + anchor + '"';
  if (std::string_view(cls) == "halo")
    out_ += " stroke=\"white\" stroke-width=\"3\" stroke-linejoin=\"round\" paint-order=\"stroke\"";
  if (!more.empty()) out_ += ' ' + std::string(more);
  out_ += '>' + escaped(words) + "</text>\n";
}

void Svg::line(double x1, double y1, double x2, double y2, const char* cls, std::string_view more) {
  const std::string_view name = cls;
  const char* stroke = name == "grid" ? "#dddddd" : name == "quiet" ? "#767676" : "#444444";
  out_ += "<line class=\"" + std::string(cls) + "\" x1=\"" + decimal(x1, 1) + "\" y1=\"" + decimal(y1, 1) +
          "\" x2=\"" + decimal(x2, 1) + "\" y2=\"" + decimal(y2, 1) + "\" stroke=\"" + stroke + '"';
  if (!more.empty()) out_ += ' ' + std::string(more);
  out_ += "/>\n";
}

void Svg::path(std::string_view d, int look, double width, std::string_view more) {
  if (d.empty()) return;
  const std::size_t colour = colourIndex(look);
  out_ += "<path class=\"" + (look < 0 ? std::string("axis") : 'k' + std::to_string(colour)) + "\" d=\"" +
          std::string(d) + "\" fill=\"none\" stroke=\"" + (look < 0 ? "#444444" : kColours[colour].hex) +
          "\" stroke-width=\"" + decimal(width, 1) + '"';
  if (!more.empty()) out_ += ' ' + std::string(more);
  out_ += "/>\n";
}

void Svg::bar(double x, double y, double width, double height, int look, std::string_view hint) {
  const std::size_t colour = colourIndex(look);
  out_ += "<rect class=\"f" + std::to_string(colour) + "\" x=\"" + decimal(x, 1) + "\" y=\"" + decimal(y, 1) +
          "\" width=\"" + decimal(std::max(width, 0.0), 1) + "\" height=\"" + decimal(height, 1) +
          "\" fill=\"" + kColours[colour].hex + '"';
  out_ += hint.empty() ? "/>\n" : "><title>" + escaped(hint) + "</title></rect>\n";
  if (static_cast<std::size_t>(std::max(look, 0)) < kColours.size()) return;
  // The colours begin again: stripes tell these from the first.
  std::string stripes;
  for (double at = x + 2.5; at < x + width - 1; at += 5)
    stripes += 'M' + point(at, y) + 'V' + decimal(y + height, 1);
  if (!stripes.empty())
    out_ += "<path d=\"" + stripes + "\" stroke=\"white\" stroke-width=\"1.5\" pointer-events=\"none\"/>\n";
}

void Svg::marker(double x, double y, double size, int shape, int colour, std::string_view hint) {
  const std::size_t index = colourIndex(colour);
  const std::string cls = colour < 0 ? "ink" : 'f' + std::to_string(index);
  std::string d;
  const auto to = [&](char command, double dx, double dy) {
    d += command + point(x + dx * size, y + dy * size);
  };
  switch (shape % kShapes) {
    case 1:
      to('M', -.88, -.88), to('L', .88, -.88), to('L', .88, .88), to('L', -.88, .88);
      break;
    case 2:
      to('M', 0, -1.2), to('L', 1.15, .85), to('L', -1.15, .85);
      break;
    case 3:
      to('M', 0, -1.3), to('L', 1.3, 0), to('L', 0, 1.3), to('L', -1.3, 0);
      break;
    case 4:
      to('M', 0, 1.2), to('L', 1.15, -.85), to('L', -1.15, -.85);
      break;
    case 5:
      to('M', -.35, -1.1), to('L', .35, -1.1), to('L', .35, -.35), to('L', 1.1, -.35), to('L', 1.1, .35);
      to('L', .35, .35), to('L', .35, 1.1), to('L', -.35, 1.1), to('L', -.35, .35), to('L', -1.1, .35);
      to('L', -1.1, -.35), to('L', -.35, -.35);
      break;
    case 6:
      to('M', -1.15, -.7), to('L', -.7, -1.15), to('L', 0, -.45), to('L', .7, -1.15), to('L', 1.15, -.7);
      to('L', .45, 0), to('L', 1.15, .7), to('L', .7, 1.15), to('L', 0, .45), to('L', -.7, 1.15);
      to('L', -1.15, .7), to('L', -.45, 0);
      break;
    default:
      d = 'M' + point(x - size, y) + 'a' + decimal(size, 1) + ' ' + decimal(size, 1) + " 0 1 0 " +
          decimal(2 * size, 1) + " 0a" + decimal(size, 1) + ' ' + decimal(size, 1) + " 0 1 0 " +
          decimal(-2 * size, 1) + " 0";
  }
  out_ += "<path class=\"mark " + cls + "\" d=\"" + d + "Z\" fill=\"" +
          (colour < 0 ? "#444444" : kColours[index].hex) + "\" stroke=\"white\" stroke-width=\"1\"";
  out_ += hint.empty() ? "/>\n" : "><title>" + escaped(hint) + "</title></path>\n";
}

double Svg::keyWidth(const Key& key) const {
  return (isBare(key) ? 14 : 36) + textWidthPx(key.name, textPx_);
}

double Svg::key(double x, double y, const Key& key) {
  if (key.line)
    path("M" + point(x, y - textPx_ * 0.35) + "h16", key.colour, 2.2,
         "stroke-dasharray=\"" + dashOf(key.colour) + '"');
  else if (key.shape >= 0)
    marker(x + 7, y - textPx_ * 0.35, 5, key.shape, key.colour);
  else if (key.colour >= 0)
    bar(x, y - textPx_ * 0.75, 14, textPx_ * 0.75, key.colour);
  text(x + (isBare(key) ? 0 : 19), y, "start", key.name);
  return keyWidth(key);
}

}  // namespace trimtab::plot
