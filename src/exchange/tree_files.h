// Skeleton files, in the scan's own coordinates, axes and units: treefile, QSM csv, skeleton PLY.
#pragma once

#include <string>
#include <vector>

#include "tree/tree.h"

namespace treerec {

// The text format of csiro-robotics/treetools: a comment line, "x,y,z,radius,parent_id" (after optional
// per-tree attributes), then one line per tree with one tuple per node, parents before children, the root's
// parent -1.
void write_treefile(const std::string& path, const Tree& tree);
// The largest tree of the file, turned to metres and Y up: up tells the file's up axis. Columns beside the
// five are skipped, but "flags" is read where we wrote it. Throws Error with a sentence for anything that is
// no treefile.
Tree read_treefile(const std::string& path, UpAxis up = UpAxis::kZ);

// One cylinder per segment, with TreeQSM's column names (start, axis, length, radius, parent, branch, order,
// measured).
void write_qsm_csv(const std::string& path, const Tree& tree);

// Vertices (x y z double, radius, flags), edges (vertex1 vertex2); binary little endian.
void write_skeleton_ply(const std::string& path, const Tree& tree);
Tree read_skeleton_ply(const std::string& path, UpAxis up = UpAxis::kZ);

}  // namespace treerec
