// The columns of tables of cylinders, as the programs call them that write such: this one, TreeQSM,
// SimpleForest, aRchi, Treegraph and rTwig. Internal to exchange/.
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

namespace treerec {

// Places in a row; -1 where there is none. A cylinder ends at `end`, or `length` along `axis` from `start`.
struct QsmColumns {
    char delimiter = ',';  // ' ' stands for any number of blanks and tabs
    size_t count = 0;      // values in a row
    int radius = -1;
    int length = -1;
    std::array<int, 3> start{-1, -1, -1};
    std::array<int, 3> axis{-1, -1, -1};
    std::array<int, 3> end{-1, -1, -1};
    // Without ids a parent is the number of its row, from 1. What is no cylinder's id, 0 or less, is no
    // parent.
    int id = -1;
    int parent = -1;
    int order = -1;     // of the branch; the trunk's is the lowest
    int measured = -1;  // 1 where the radius was fitted
    int added = -1;     // 0 likewise
};

// From the line of names; nothing if they do not describe cylinders.
std::optional<QsmColumns> find_qsm_columns(std::string_view line);

// The values of a row, without blanks and quotes around them; none for an empty row. A last one that is empty
// does not count.
void split_row(std::string_view line, char delimiter, std::vector<std::string_view>& words);

}  // namespace treerec
