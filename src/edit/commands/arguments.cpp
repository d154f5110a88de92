#include "edit/commands/arguments.h"

#include <charconv>
#include <cmath>
#include <stdexcept>

#include "edit/commands/address.h"
#include "edit/select.h"

namespace treerec {

namespace {

// Of a limit: what passes it by less, as 0.1 + 0.8 passes 0.9, is the limit.
constexpr double kRounding = 1e-9;

double within_limits(double value, double least, double most) {
    const auto near = [&](double limit) { return std::abs(value - limit) <= kRounding * std::abs(limit); };
    return value < least && near(least) ? least : value > most && near(most) ? most : value;
}

Parameter bare(const char* name, ParameterType type, const char* help) {
    Parameter parameter;
    parameter.name = name;
    parameter.type = type;
    parameter.help = help;
    parameter.required = true;
    return parameter;
}

Parameter ranged(const char* name, ParameterType type, double least, double most, const char* help) {
    Parameter parameter = bare(name, type, help);
    parameter.least = parameter.from = least;
    parameter.most = parameter.to = most;
    return parameter;
}

Parameter with_standard(Parameter parameter, std::string standard) {
    parameter.standard = std::move(standard);
    parameter.required = false;
    return parameter;
}

std::string joined(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words)
        text += (text.empty() ? "" : " ") + word;
    return text;
}

}  // namespace

const char* parameter_type_name(ParameterType type) {
    constexpr const char* kNames[] = {"number", "whole", "length", "switch", "word",     "text",
                                      "node",   "nodes", "point",  "offset", "direction"};
    return kNames[static_cast<size_t>(type)];
}

Parameter Parameter::slider(double slider_from, double slider_to) const {
    Parameter copy = *this;
    copy.from = slider_from;
    copy.to = slider_to;
    return copy;
}

Parameter Parameter::needed() const {
    Parameter copy = *this;
    copy.required = true;
    copy.standard.clear();
    return copy;
}

Parameter Parameter::optional() const {
    Parameter copy = *this;
    copy.required = false;
    return copy;
}

Parameter number_parameter(const char* name, double standard, double least, double most, const char* help) {
    const Parameter parameter = ranged(name, ParameterType::kNumber, least, most, help);
    return std::isnan(standard) ? parameter : with_standard(parameter, number_text(standard));
}

Parameter length_parameter(const char* name, double standard, double least, double most, const char* help) {
    const Parameter parameter = ranged(name, ParameterType::kLength, least, most, help);
    return std::isnan(standard) ? parameter : with_standard(parameter, number_text(standard));
}

Parameter whole_parameter(const char* name, int64_t standard, int64_t least, int64_t most, const char* help) {
    return with_standard(
        ranged(name, ParameterType::kWhole, static_cast<double>(least), static_cast<double>(most), help),
        std::to_string(standard));
}

Parameter switch_parameter(const char* name, bool standard, const char* help) {
    return with_standard(bare(name, ParameterType::kSwitch, help), standard ? "yes" : "no");
}

Parameter word_parameter(const char* name, std::vector<std::string> words, const char* help) {
    Parameter parameter = with_standard(bare(name, ParameterType::kWord, help), words.front());
    parameter.words = std::move(words);
    return parameter;
}

Parameter text_parameter(const char* name, std::vector<std::string> examples, const char* help) {
    Parameter parameter = bare(name, ParameterType::kText, help);
    parameter.words = std::move(examples);
    return parameter;
}

Parameter node_parameter(const char* name, const char* help) {
    return bare(name, ParameterType::kNode, help);
}

Parameter point_parameter(const char* name, const char* help) {
    return bare(name, ParameterType::kPoint, help);
}

Parameter offset_parameter(const char* name, const char* help) {
    return bare(name, ParameterType::kOffset, help);
}

Parameter direction_parameter(const char* name, const char* help) {
    return bare(name, ParameterType::kDirection, help);
}

Parameter nodes_parameter(const char* name, const char* standard, const char* help) {
    const Parameter parameter = bare(name, ParameterType::kNodes, help);
    return *standard ? with_standard(parameter, standard) : parameter;
}

EditArguments::EditArguments(const Tree& tree, const CommandLine& line,
                             const std::vector<Parameter>& parameters, const BindOptions& options)
    : line_(line.name), progress_(options.progress) {
    std::vector<std::string> names;
    for (const Parameter& parameter : parameters)
        names.push_back(parameter.name);
    const auto takes = [&](std::string_view name) {
        for (const std::string& known : names)
            if (known == name) return true;
        return false;
    };
    for (const CommandWord& word : line.words)
        if (!takes(word.key) && !(word.key == "at" && takes("node")))
            throw CommandError(
                "'" + line.name + "' takes no '" + word.key + "'" +
                    (names.empty() ? "; it takes nothing." : "; it takes " + joined(names) + "."),
                word.column);
    for (const Parameter& parameter : parameters) {
        const CommandWord* given = nullptr;
        std::string text;
        for (const CommandWord& word : line.words) {
            const bool place = parameter.name == "node" && word.key == "at" && !takes("at");
            if (word.key != parameter.name && !place) continue;
            if (given) throw CommandError("Give either 'node' or 'at'.", word.column);
            given = &word;
            text = word.value;
            if (!place) continue;
            text = "@" + text;
            for (char& c : text)
                if (c == ',') c = ':';
        }
        if (!given && parameter.required)
            throw CommandError("'" + line.name + "' needs " + parameter.name + "=: " + parameter.help + ".",
                               line.column);
        if (!given && parameter.standard.empty()) continue;
        // Standards are metres of any frame.
        std::string kept;
        values_.push_back(given ? read(tree, parameter, text, given->value_column, options, kept)
                                : read(tree, parameter, parameter.standard, line.column, {}, kept));
        if (given) append_word(line_, parameter.name, kept);
    }
}

EditArguments::Value EditArguments::read(const Tree& tree, const Parameter& parameter, std::string_view text,
                                         size_t column, const BindOptions& options, std::string& kept) {
    const auto wrong = [&](const std::string& what) {
        return CommandError("'" + parameter.name + "' must be " + what + ", not " + quote_word(text) + ".",
                            column);
    };
    const ScanFrame& frame = tree.frame();
    Value result{parameter.name, false};
    kept = text;
    switch (parameter.type) {
        case ParameterType::kNumber:
        case ParameterType::kLength: {
            std::optional<double> value = read_number(text);
            if (value && parameter.type == ParameterType::kLength && options.written_in)
                *value = length_between(*options.written_in, frame, *value);
            if (value) *value = within_limits(*value, parameter.least, parameter.most);
            if (!value || *value < parameter.least || *value > parameter.most)
                throw wrong("a number from " + number_text(parameter.least) + " to " +
                            number_text(parameter.most));
            result.value = *value;
            kept = number_text(*value);
            break;
        }
        case ParameterType::kWhole: {
            int64_t value = 0;
            const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
            if (failure != std::errc() || end != text.data() + text.size() ||
                static_cast<double>(value) < parameter.least || static_cast<double>(value) > parameter.most)
                throw wrong("a whole number from " + std::to_string(static_cast<int64_t>(parameter.least)) +
                            " to " + std::to_string(static_cast<int64_t>(parameter.most)));
            result.value = value;
            break;
        }
        case ParameterType::kSwitch:
            if (text != "yes" && text != "no") throw wrong("yes or no");
            result.value = text == "yes";
            break;
        case ParameterType::kWord:
            for (const std::string& word : parameter.words)
                if (word == text) result.value = word;
            if (!std::holds_alternative<std::string>(result.value))
                throw wrong("one of: " + joined(parameter.words));
            break;
        case ParameterType::kText:
            result.value = std::string(text);
            break;
        case ParameterType::kNode:
            try {
                const NodeId id = find_node(tree, text, options.tolerance);
                if (text != "root") kept = address_of(tree, id);
                result.value = id;
            } catch (const Misfit&) {
                throw;
            } catch (const Error& error) {
                throw CommandError(error.what(), column);
            }
            break;
        case ParameterType::kNodes:
            try {
                Selection selection =
                    select(tree, text, {options.tolerance, options.written_in, options.keep_going});
                kept = selection.text;
                named_ += selection.named;
                missing_ += selection.missing;
                result.value = std::move(selection.ids);
            } catch (const CommandError& error) {
                throw CommandError(error.what(), column + error.column() - 1);
            }
            break;
        case ParameterType::kPoint:
        case ParameterType::kOffset:
        case ParameterType::kDirection: {
            const std::optional<std::vector<double>> n = read_numbers(text, ',', 3);
            if (!n) throw wrong("three numbers x,y,z");
            DVec3 v((*n)[0], (*n)[1], (*n)[2]);
            if (options.written_in) {
                if (parameter.type == ParameterType::kPoint)
                    v = point_between(*options.written_in, frame, v);
                else
                    v = direction_between(*options.written_in, frame, v);
                if (parameter.type == ParameterType::kOffset)
                    v *= length_between(*options.written_in, frame, 1.0);
            }
            kept = vector_text(v);
            if (parameter.type == ParameterType::kDirection) {
                v = normalized_or(v, DVec3(0.0));
                if (v == DVec3(0.0)) throw wrong("a direction, which is not zero");
            }
            result.value = v;
            break;
        }
    }
    return result;
}

bool EditArguments::has(std::string_view name) const {
    for (const Value& value : values_)
        if (value.name == name) return true;
    return false;
}

const EditArguments::Value& EditArguments::find(std::string_view name) const {
    for (const Value& value : values_)
        if (value.name == name) return value;
    throw std::logic_error("a command asked for '" + std::string(name) + "', which it does not declare");
}

double EditArguments::number(std::string_view name) const {
    return std::get<double>(find(name).value);
}

int64_t EditArguments::whole(std::string_view name) const {
    return std::get<int64_t>(find(name).value);
}

bool EditArguments::on(std::string_view name) const {
    return std::get<bool>(find(name).value);
}

const std::string& EditArguments::text(std::string_view name) const {
    return std::get<std::string>(find(name).value);
}

NodeId EditArguments::node(std::string_view name) const {
    return std::get<NodeId>(find(name).value);
}

const std::vector<NodeId>& EditArguments::nodes(std::string_view name) const {
    return std::get<std::vector<NodeId>>(find(name).value);
}

DVec3 EditArguments::vector(std::string_view name) const {
    return std::get<DVec3>(find(name).value);
}

}  // namespace treerec
