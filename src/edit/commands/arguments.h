// What a command takes, and what it was given.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "edit/commands/command_text.h"
#include "progress.h"
#include "tree/tree.h"

namespace treerec {

enum class ParameterType : uint8_t {
    kNumber,     // 1.5
    kWhole,      // 3
    kLength,     // metres
    kSwitch,     // yes or no
    kWord,       // one of a list
    kText,       // anything
    kNode,       // edit/commands/address.h
    kNodes,      // edit/select.h
    kPoint,      // x,y,z in metres of tree space
    kOffset,     // likewise, from wherever
    kDirection,  // likewise, of any length but zero
};
const char* parameter_type_name(ParameterType type);  // "number", "whole", "length", ...

struct Parameter {
    std::string name;
    ParameterType type = ParameterType::kNumber;
    std::string help;      // one sentence without a full stop
    std::string standard;  // what it is where it is not given; empty: nothing
    bool required = false;
    double least = 0.0;  // numbers outside are refused
    double most = 0.0;
    double from = 0.0;  // where a slider begins and ends; tests draw from here too
    double to = 0.0;
    std::vector<std::string> words;  // those that can be chosen; of a text: examples

    // For numbers: the slider's ends where they are not the limits.
    Parameter slider(double slider_from, double slider_to) const;
    // It must be given; or it need not be, though there is no standard.
    Parameter needed() const;
    Parameter optional() const;
};

// `standard`: NAN for a number that must be given.
Parameter number_parameter(const char* name, double standard, double least, double most, const char* help);
Parameter length_parameter(const char* name, double standard, double least, double most, const char* help);
Parameter whole_parameter(const char* name, int64_t standard, int64_t least, int64_t most, const char* help);
Parameter switch_parameter(const char* name, bool standard, const char* help);
// The first word is the standard.
Parameter word_parameter(const char* name, std::vector<std::string> words, const char* help);
// These must be given, unless optional().
Parameter text_parameter(const char* name, std::vector<std::string> examples, const char* help);
Parameter node_parameter(const char* name, const char* help);
Parameter point_parameter(const char* name, const char* help);
Parameter offset_parameter(const char* name, const char* help);
Parameter direction_parameter(const char* name, const char* help);
// A standard such as "all"; empty: it must be given.
Parameter nodes_parameter(const char* name, const char* standard, const char* help);

struct BindOptions {
    double tolerance = 0.0;  // metres, of addresses (find_node())
    // The frame in which lengths and places were written, so that they stay where they were in the scan;
    // null: the tree's own.
    const ScanFrame* written_in = nullptr;
    // Of a list of nodes, those that are not there are left out (SelectOptions).
    bool keep_going = false;
    const Progress* progress = nullptr;
};

// Values that are right for their parameters: a command's function need not look again.
class EditArguments {
  public:
    // Reads a line's values for the parameters. A parameter called "node" may be given as at=x,y,z too, in
    // the scan's coordinates. Throws CommandError for what is no such value and Misfit for a node that is not
    // there.
    EditArguments(const Tree& tree, const CommandLine& line, const std::vector<Parameter>& parameters,
                  const BindOptions& options);

    // Whether it was given or has a standard. The others must only be asked for what there is.
    bool has(std::string_view name) const;
    double number(std::string_view name) const;  // and lengths
    int64_t whole(std::string_view name) const;
    bool on(std::string_view name) const;
    const std::string& text(std::string_view name) const;  // and words
    NodeId node(std::string_view name) const;
    const std::vector<NodeId>& nodes(std::string_view name) const;  // in depth-first order
    DVec3 vector(std::string_view name) const;  // points, offsets and directions; the latter are unit

    const Progress* progress() const { return progress_; }
    // The line as a log keeps it: what was given, in the tree's frame, nodes by address.
    const std::string& line() const { return line_; }
    // How many places the lists of nodes named, and how many of these were not there (keep_going).
    size_t named() const { return named_; }
    size_t missing() const { return missing_; }

  private:
    struct Value {
        std::string name;
        std::variant<double, int64_t, bool, std::string, NodeId, std::vector<NodeId>, DVec3> value;
    };

    Value read(const Tree& tree, const Parameter& parameter, std::string_view text, size_t column,
               const BindOptions& options, std::string& kept);
    const Value& find(std::string_view name) const;

    std::vector<Value> values_;
    std::string line_;
    size_t named_ = 0, missing_ = 0;
    const Progress* progress_ = nullptr;
};

}  // namespace treerec
