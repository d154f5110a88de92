// The readers of skeleton files on bytes in memory: what exchange/tree_files.h reads, without its files.
// Internal to exchange/ and to the tests.
#pragma once

#include <string>
#include <string_view>

#include "geometry/scan_frame.h"
#include "tree/tree.h"

namespace treerec {

// `path` is for the sentences alone. Throw Error.
Tree parse_treefile(std::string_view bytes, const std::string& path, UpAxis up);
Tree parse_node_csv(std::string_view bytes, const std::string& path, UpAxis up);
Tree parse_qsm_csv(std::string_view bytes, const std::string& path, UpAxis up);
Tree parse_skeleton_ply(std::string_view bytes, const std::string& path, UpAxis up);

}  // namespace treerec
