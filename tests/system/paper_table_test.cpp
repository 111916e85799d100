// The README says of every numbered fact of the paper where it lives and what shows it.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace nextview {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> lines_of(const fs::path& file) {
  std::ifstream in(fs::path(NEXTVIEW_SOURCE_DIR) / file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// The paths that a cell of a table links to.
std::vector<std::string> links_in(const std::string& cell) {
  static const std::regex kLink(R"(\]\(([^)]+)\))");
  std::vector<std::string> links;
  for (std::sregex_iterator it(cell.begin(), cell.end(), kLink), end; it != end; ++it) {
    links.push_back((*it)[1]);
  }
  return links;
}

std::vector<std::string> cells_of(const std::string& row) {
  std::vector<std::string> cells;
  std::istringstream in(row);
  for (std::string cell; std::getline(in, cell, '|');) cells.push_back(cell);
  return cells;  // the first is what stands before the first bar
}

TEST(PaperTable, SaysOfEveryFactWhereItLivesAndWhatShowsIt) {
  static const std::regex kFact(R"(\| P(\d+) \|.*)");
  int facts = 0;
  std::smatch number;
  for (const std::string& line : lines_of("README.md")) {
    if (!std::regex_match(line, number, kFact)) continue;
    EXPECT_EQ(std::stoi(number[1]), ++facts) << line;
    const std::vector<std::string> cells = cells_of(line);
    ASSERT_EQ(cells.size(), 5U) << line;
    for (const std::size_t column : {std::size_t{3}, std::size_t{4}}) {
      EXPECT_FALSE(links_in(cells[column]).empty()) << line;
      for (const std::string& link : links_in(cells[column])) {
        EXPECT_TRUE(fs::exists(fs::path(NEXTVIEW_SOURCE_DIR) / link)) << link;
        EXPECT_EQ(link.starts_with("tests/"), column == 4) << link;
      }
    }
  }
  EXPECT_EQ(facts, 30);
}

TEST(PaperTable, HasTheFactsOfThePage) {
  static const std::regex kFact(R"(- \*\*P(\d+) .*)");
  int facts = 0;
  std::smatch number;
  for (const std::string& line : lines_of("docs/paper.md")) {
    if (!std::regex_match(line, number, kFact)) continue;
    EXPECT_EQ(std::stoi(number[1]), ++facts) << line;
  }
  EXPECT_EQ(facts, 30);
}

}  // namespace
}  // namespace nextview
