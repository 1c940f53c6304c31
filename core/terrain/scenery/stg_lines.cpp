#include "stg_lines.h"

namespace trimtab::terrain {

void forEachStgLine(const std::string& text, const std::function<void(StgLine&)>& use) {
  std::istringstream in(text);
  std::uint32_t number = 0;
  for (std::string line; std::getline(in, line);) {
    StgLine read;
    read.number = ++number;
    read.bytes = line.size();
    if (!read.tooLong()) {
      read.words.str(line.substr(0, line.find('#')));
      if (!(read.words >> read.verb)) continue;
    }
    use(read);
  }
}

}  // namespace trimtab::terrain
