// The readers of skeleton files on bytes in memory: what exchange/tree_files.h reads, without its files.
// Internal to exchange/ and to the tests.
#pragma once

#include <string>
#include <string_view>

#include "exchange/tree_files.h"
#include "tree/tree.h"

namespace treerec {

// `path` is for the sentences alone. Throw Error.
Tree parse_treefile(std::string_view bytes, const std::string& path, const SkeletonChoice& choice,
                    SkeletonReport* report = nullptr);
Tree parse_node_csv(std::string_view bytes, const std::string& path, const SkeletonChoice& choice,
                    SkeletonReport* report = nullptr);
Tree parse_qsm_csv(std::string_view bytes, const std::string& path, const SkeletonChoice& choice,
                   SkeletonReport* report = nullptr);
Tree parse_swc(std::string_view bytes, const std::string& path, const SkeletonChoice& choice,
               SkeletonReport* report = nullptr);
Tree parse_skeleton_ply(std::string_view bytes, const std::string& path, const SkeletonChoice& choice,
                        SkeletonReport* report = nullptr);
Tree parse_mtg(std::string_view bytes, const std::string& path, const SkeletonChoice& choice,
               SkeletonReport* report = nullptr);
Tree parse_qsm_sections(std::string_view bytes, const std::string& path, const SkeletonChoice& choice,
                        SkeletonReport* report = nullptr);

// Whether a file's beginning is that of an MTG, or of a QSM in sections.
bool looks_like_mtg(std::string_view bytes);
bool looks_like_qsm_sections(std::string_view bytes);
// Whether a file's beginning is SWC: rows of an id, a type, three coordinates, a radius and a parent, of
// which one is -1. whole_file: the last line is not cut off.
bool looks_like_swc(std::string_view bytes, bool whole_file);

}  // namespace treerec
