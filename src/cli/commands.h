// The program's commands. Each takes the words after its name, throws Error or UsageError, and prints its
// result on stdout.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/arguments.h"
#include "geometry/scan_frame.h"
#include "lsystem/lstring.h"
#include "pipeline/export.h"
#include "scan/formats/read_cloud.h"
#include "tree/tree.h"

namespace treerec {

// What several commands read in the same way: "--up x" (default z), "--columns x,y,z" and "--classes 4-5" of
// clouds, "--tree 2" of skeletons. Throw UsageError.
UpAxis up_axis_from(const Arguments& arguments);
ReadCloudOptions read_options_from(const Arguments& arguments);
// The skeleton at `path`, of the number that `option` names ("" takes the largest); what there is to say of
// it goes to stderr. Throws Error, and UsageError.
Tree skeleton_from(const Arguments& arguments, const std::string& path, const std::string& option = "--tree",
                   std::optional<LStringDialect> dialect = std::nullopt);
// "--levels" of a model.
int levels_from(const Arguments& arguments);
// How a model is to be: "--leaves birch" (or what else names a kind of leaves), "--seed", "--levels" and
// "--pictures-beside", of those that the command has. Throws UsageError.
ExportOptions exports_from(const Arguments& arguments, const std::string& leaves = "--leaves");
// "--dialect paper" (default turtle). Throws UsageError.
LStringDialect dialect_from(const Arguments& arguments);
// The same of a command that reads an L-string; nothing without it.
std::optional<LStringDialect> told_dialect_from(const Arguments& arguments);

// Throws UsageError where a file at `path` has something in it and is not of ours, which begin with `mark` in
// their first 4 kB: to be asked for what no -o names. what: "no report of a reconstruction".
void require_own(const std::string& path, std::string_view mark, const std::string& what);

// The same of a cleaned cloud; of text and LAS, which have no such line, none can be told to be ours.
void require_own_cloud(const std::string& path);

const Command& reconstruct_command();
void run_reconstruct(const std::vector<std::string>& words);

const Command& split_command();
void run_split(const std::vector<std::string>& words);

const Command& photos_command();
void run_photos(const std::vector<std::string>& words);

const Command& info_command();
void run_info(const std::vector<std::string>& words);

const Command& score_command();
void run_score(const std::vector<std::string>& words);

const Command& bark_command();
void run_bark(const std::vector<std::string>& words);

const Command& edit_command();
void run_edit(const std::vector<std::string>& words);

const Command& lighten_command();
void run_lighten(const std::vector<std::string>& words);

const Command& synth_command();
void run_synth(const std::vector<std::string>& words);

const Command& lstring_command();
void run_lstring(const std::vector<std::string>& words);

const Command& grow_command();
void run_grow(const std::vector<std::string>& words);

const Command& marker_command();
void run_marker(const std::vector<std::string>& words);

const Command& sketch_command();
void run_sketch(const std::vector<std::string>& words);
// Of --onto, in sketch_onto.cpp.
void run_sketch_onto(const Arguments& arguments);

const Command& textures_command();
void run_textures(const std::vector<std::string>& words);

}  // namespace treerec
