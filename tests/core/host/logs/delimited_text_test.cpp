#include "core/host/logs/delimited_text.h"

#include <gtest/gtest.h>

#include <chrono>

namespace trimtab {
namespace {

using Rows = std::vector<std::vector<std::string>>;

/// Header and rows, or what the refusal says.
struct Table {
  std::vector<std::string> header;
  Rows rows;
  std::string told;
};

Table tableOf(const std::string& text) {
  DelimitedText table(text, "t.csv");
  Findings findings;
  Table read;
  if (table.open(findings)) {
    read.header = table.header();
    while (table.nextRow()) read.rows.emplace_back(table.cells().begin(), table.cells().end());
  }
  read.told = toString(findings);
  return read;
}

std::string utf16(const std::string& ascii, bool bigEndian) {
  std::string text = bigEndian ? "\xfe\xff" : "\xff\xfe";
  for (const char c : ascii) {
    if (bigEndian) text += '\0';
    text += c;
    if (!bigEndian) text += '\0';
  }
  return text;
}

TEST(DelimitedText, readsOneTableHoweverItIsWritten) {
  const std::vector<std::string> header{"a", "b", "c"};
  const Rows rows{{"1", "2.5", "x"}, {"3", "4.5", "y"}};
  const std::string plain = "a,b,c\n1,2.5,x\n3,4.5,y\n";
  for (const std::string& text :
       {plain, std::string("\xef\xbb\xbf") + plain, std::string("a;b;c\r\n1;2.5;x\r\n3;4.5;y\r\n"),
        std::string("a,b,c\r1,2.5,x\r3,4.5,y\r"), std::string("a\tb\tc\n1\t2.5\tx\n3\t4.5\ty"),
        std::string("  a | b | c |\n  1 | 2.5 | x |\n  3 | 4.5 | y |\n"),
        std::string("a b  c\n 1 2.5 x \n3 4.5 y\n"),
        std::string("\"a\",\"b\",\"c\"\n\"1\",2.5,\"x\"\n3,4.5,y\n"),
        std::string("a,b,c,,\n1,2.5,x,,\n3,4.5,y\n"),
        std::string("# by hand\n// or not\n\na,b,c\n1,2.5,x\n#\n3,4.5,y\n"),
        std::string("sep=;\na;b;c\n1;2.5;x\n3;4.5;y\n"), std::string("# a,b,c\n1,2.5,x\n3,4.5,y\n"),
        utf16(plain, false), utf16(plain, true)}) {
    const Table table = tableOf(text);
    EXPECT_EQ(table.header, header) << text << table.told;
    EXPECT_EQ(table.rows, rows) << text << table.told;
  }
}

TEST(DelimitedText, keepsEmptyCellsAndColumnsWithoutAName) {
  const Table table = tableOf(",a,b\n0,1,\n,2,3\n");
  EXPECT_EQ(table.header, (std::vector<std::string>{"", "a", "b"}));
  EXPECT_EQ(table.rows, (Rows{{"0", "1", ""}, {"", "2", "3"}}));
  EXPECT_EQ(tableOf("\ta\tb\n\t1\t2\n").rows, (Rows{{"", "1", "2"}}));
}

TEST(DelimitedText, readsQuotesAsRfc4180Says) {
  EXPECT_EQ(tableOf("a,b\n\"1,2\",\"say \"\"yes\"\"\"\n\"two\nlines\",3\n4,5\n").rows,
            (Rows{{"1,2", "say \"yes\""}, {"two\nlines", "3"}, {"4", "5"}}));
  // A stray mark swallows neither its line nor the file.
  EXPECT_EQ(tableOf("a,b\n1,5\"\n2,6\n").rows, (Rows{{"1", "5\""}, {"2", "6"}}));
  EXPECT_EQ(tableOf("a,b\n1,\"x\n2,6\n").rows, (Rows{{"1", "\"x"}, {"2", "6"}}));
}

TEST(DelimitedText, findsTheDelimiterByTheRowsWhereTheHeaderHasTwo) {
  const Table table = tableOf("_real,_time |  lat,__deg |\n  1.5 |  47.25 |\n");
  EXPECT_EQ(table.header, (std::vector<std::string>{"_real,_time", "lat,__deg"}));
  EXPECT_EQ(table.rows, (Rows{{"1.5", "47.25"}}));
  EXPECT_NE(tableOf("a,b;c\nx,y;z\n").told.find("write the file with one of them"), std::string::npos);
}

TEST(DelimitedText, readsADecimalCommaAndRefusesTwoMarks) {
  const std::string text = "a;b\n0,5;7\n-1,25e1;8\n";
  DelimitedText table(text, "t.csv");
  Findings findings;
  ASSERT_TRUE(table.open(findings));
  EXPECT_NE(toString(findings).find("decimal comma"), std::string::npos);
  ASSERT_TRUE(table.nextRow());
  EXPECT_EQ(table.number(table.cells()[0]), 0.5);
  ASSERT_TRUE(table.nextRow());
  EXPECT_EQ(table.number(table.cells()[0]), -12.5);
  EXPECT_EQ(table.number(" +3 "), 3);
  EXPECT_NE(tableOf("a;b\n0,5;1\n2;0.5\n").told.find("\"0.5\" in line 3 and \"0,5\" in line 2"),
            std::string::npos);
  EXPECT_NE(tableOf("a;b\n3,000;1\n4,500;2\n").told.find("group thousands"), std::string::npos);
}

TEST(DelimitedText, saysWhatIsNoTable) {
  for (const auto& [text, says] : {std::pair{"<?xml version=\"1.0\"?><gpx/>", "GPX"},
                                   {"{\"a\": 1}", "JSON"},
                                   {"<!DOCTYPE html><html>", "HTML"},
                                   {"PK\x03\x04...", "Excel"},
                                   {"a,b\n1,2,3\n4,5,6\n", "a name for each of the 3 cells"},
                                   {"a,b\n0,5,7,25\n0,75,8,5\n", "if commas are decimal"},
                                   {"\n#\n", "an empty file"}})
    EXPECT_NE(tableOf(text).told.find(says), std::string::npos) << tableOf(text).told;
}

TEST(DelimitedText, namesColumnsByNumberWhereThereIsNoHeader) {
  EXPECT_EQ(tableOf("1,2\n3,4\n").header, (std::vector<std::string>{"#1", "#2"}));
  EXPECT_EQ(tableOf("1,2\n3,4\n").rows.size(), 2U);
}

/// Each line opens a quotation mark that is never closed: the worst for a reader that looks for its end.
TEST(DelimitedText, takesTimeInProportionToTheText) {
  std::string text = "a,b\n";
  for (int i = 0; i < 200000; ++i) text += "\"x,'\n";
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_LT(tableOf(text).rows.size(), 200001U);
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), 5);
}

}  // namespace
}  // namespace trimtab
