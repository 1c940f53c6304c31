#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support.h"
#include "trimtab/host/flight.h"

/// What another program reads in CIGI messages.
namespace trimtab::test {

/// What tshark reads in each message of `datagrams`, field by field; of a field that a message has twice the
/// `occurrence`: f(irst) or l(ast).
inline std::vector<std::map<std::string, double>> dissected(const std::vector<CapturedDatagram>& datagrams,
                                                            const std::vector<std::string>& fields,
                                                            char occurrence = 'f') {
  ScratchDir dir;
  const auto written = writePcap(dir / "sent.pcap", datagrams);
  EXPECT_TRUE(written) << toString(written.findings());
  std::string command = "tshark -r '" + (dir / "sent.pcap").string() +
                        "' -d udp.port==8004,cigi -T fields -E separator=, -E occurrence=" + occurrence;
  for (const std::string& field : fields) command += " -e " + field;
  const Ran ran = run(command);
  EXPECT_EQ(ran.exitCode, 0) << ran.err;
  std::vector<std::map<std::string, double>> rows;
  std::istringstream lines(ran.out);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    std::map<std::string, double> row;
    for (const std::string& field : fields) {
      std::string cell;
      std::getline(cells, cell, ',');
      if (cell == "True") cell = "1";
      if (cell == "False") cell = "0";
      row[field] = cell.empty() ? std::nan("") : std::strtod(cell.c_str(), nullptr);
    }
    rows.push_back(row);
  }
  return rows;
}

inline void expectFields(const std::map<std::string, double>& row,
                         const std::map<std::string, double>& expected) {
  for (const auto& [field, value] : expected) {
    const auto found = row.find(field);
    ASSERT_NE(found, row.end()) << field;
    EXPECT_NEAR(found->second, value, 1e-6 * std::max(1.0, std::abs(value))) << field;
  }
}

inline std::vector<std::string> names(const std::map<std::string, double>& expected) {
  std::vector<std::string> fields;
  for (const auto& [field, value] : expected) fields.push_back(field);
  return fields;
}

}  // namespace trimtab::test
