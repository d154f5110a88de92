// Skeleton files, in the scan's own coordinates, axes and units: treefile, QSM csv, skeleton PLY, node csv,
// SWC, MTG.
//
// Positions and radii are written as the shortest decimal (or the double itself) that reads back the same, at
// UTM coordinates too. Files that we wrote name their up axis and unit and read back into the same place;
// for others `up` tells the axis, and a unit is a metre. A file of a newer format version is refused.
// All readers give a tree whose frame's origin is its root, and throw Error with a sentence for anything that
// is no such file, for a tree of a single node or without any length, and for places and radii that are
// damage.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "foliage/foliage.h"
#include "lsystem/lstring.h"
#include "tree/tree.h"

namespace treerec {

// What is read of a skeleton file.
struct SkeletonChoice {
    UpAxis up;    // of files that do not say
    size_t tree;  // of a file with several: its number in the file's order, from 1; 0: the largest
    // Of an L-string, whatever its heading says; nothing: as that says, or a turtle's.
    std::optional<LStringDialect> dialect;

    SkeletonChoice(UpAxis up_axis = UpAxis::kZ, size_t number = 0,
                   std::optional<LStringDialect> string_dialect = std::nullopt)
        : up(up_axis), tree(number), dialect(string_dialect) {}
};

// What there was to read.
struct SkeletonReport {
    size_t trees = 1;                   // of the file
    size_t taken = 1;                   // the number of the one that was read
    std::vector<std::string> warnings;  // sentences for the user
    Foliage foliage;                    // of the one that was read, in its frame; empty where none is told
};

// The text format of csiro-robotics/treetools and raycloudtools: comment lines, the line of field names
// "x,y,z,radius,parent_id,flags" and a line per tree with one tuple per node, parents before children, the
// root's parent -1. A node's radius is that of the segment to its parent. Measured sections stand in
// comments, which other programs skip (section_lines.h), and so does the foliage of the tree's frame, what
// the scan saw of leaves (foliage_lines.h).
void write_treefile(const std::string& path, const Tree& tree, const Foliage& foliage = {});
// One tree of the file. Reads per-tree attributes before the fields, more fields (skipped, but for
// "flags"), and the second list of fields by which newer files tell branch fields from root fields.
Tree read_treefile(const std::string& path, const SkeletonChoice& choice = {},
                   SkeletonReport* report = nullptr);

// One cylinder per segment, parents first, with TreeQSM's columns: radius, length, start_x.., axis_x..,
// parent_1based (0: none), branch (from 1), order (trunk 0), and measured (1: the radius was fitted).
void write_qsm_csv(const std::string& path, const Tree& tree);
// Reads these columns in any order, with or without order and measured, and the tables of TreeQSM (the text
// of its cylinders, or a csv of them), SimpleForest, aRchi, Treegraph and rTwig by their own names
// (qsm_columns.h). Each cylinder ends in a node and hangs on its parent's end, so that a gap between the two
// is bridged; further cylinders without a parent hang on the root. Also the text of several sections that
// TreeQSM exports for modelling programs: "# Cylinder data", whose rows have no names, then others.
Tree read_qsm_csv(const std::string& path, const SkeletonChoice& choice = {},
                  SkeletonReport* report = nullptr);

// Vertices (x y z radius: double, flags: uchar), edges (vertex1 the parent, vertex2 the child: int); binary
// little endian. Read in any of PLY's three encodings, with more properties or elements. Edges of other
// programs may be lists of two vertices, lead either way, and join at vertices that lie at one place, as
// AdTree and Easy3D write them: see skeleton_graph.h for what becomes the tree.
void write_skeleton_ply(const std::string& path, const Tree& tree);
Tree read_skeleton_ply(const std::string& path, const SkeletonChoice& choice = {},
                       SkeletonReport* report = nullptr);

// A table of nodes with a header naming x, y, z, radius, parent (or parent_id) and perhaps id (or node): the
// form in which hand-corrected skeletons are exchanged. A parent that is no node marks a tree's root.
Tree read_node_csv(const std::string& path, const SkeletonChoice& choice = {},
                   SkeletonReport* report = nullptr);

// Lines of id, type, x, y, z, radius and parent (-1: none), as skeletons of neurons and of some plants are
// kept; a unit is a metre.
Tree read_swc(const std::string& path, const SkeletonChoice& choice = {}, SkeletonReport* report = nullptr);

// As plantscan3d writes them: a plant of nodes with places and radii in the scan's own coordinates.
void write_mtg(const std::string& path, const Tree& tree);
// Multiscale tree graphs (C. Godin, Y. Caraglio, "A multiscale model of plant topological structures", 1998)
// in the form of OpenAlea's and AMAPmod's text files, as plantscan3d writes them: every line with features
// XX, YY and ZZ and a radius (or diameter) is a node; the tabs before its code tell what it grows on.
Tree read_mtg(const std::string& path, const SkeletonChoice& choice = {}, SkeletonReport* report = nullptr);

// Whether the file's first lines say that it is one of the skeleton files read here (and not a point cloud).
// Throws Error only if there is no such file.
bool is_skeleton_file(const std::string& path);
// Any of them, told apart by their contents. Where the file does not say which nodes are trunk, it is found.
Tree read_skeleton(const std::string& path, const SkeletonChoice& choice = {},
                   SkeletonReport* report = nullptr);

}  // namespace treerec
