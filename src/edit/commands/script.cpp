#include "edit/commands/script.h"

#include <algorithm>
#include <charconv>
#include <optional>

#include "edit/commands/address.h"
#include "edit/commands/command_text.h"

namespace treerec {

namespace {

constexpr std::string_view kHeader = "# treerec edit log ";
constexpr int kLogVersion = 1;
constexpr std::string_view kUnfit = "#? ";
constexpr std::string_view kReason = "# This did not fit: ";

std::string frame_line(const ScanFrame& frame) {
    std::string line = "frame";
    append_word(line, "origin", vector_text(frame.origin));
    append_word(line, "unit", number_text(frame.metres_per_unit));
    append_word(line, "up", up_axis_name(frame.up));
    if (frame.tilt != DVec3(0.0)) append_word(line, "tilt", vector_text(frame.tilt));
    return line;
}

ScanFrame parse_frame(const CommandLine& line) {
    ScanFrame frame;
    for (const CommandWord& word : line.words) {
        const auto wrong = [&](const char* what) {
            return CommandError(
                "'" + word.key + "' must be " + what + ", not " + quote_word(word.value) + ".",
                word.value_column);
        };
        if (word.key == "origin") {
            const std::optional<std::vector<double>> n = read_numbers(word.value, ',', 3);
            if (!n) throw wrong("three numbers x,y,z");
            frame.origin = {(*n)[0], (*n)[1], (*n)[2]};
        } else if (word.key == "unit") {
            const std::optional<double> unit = read_number(word.value);
            if (!unit || !(*unit > 0.0)) throw wrong("a positive number of metres");
            frame.metres_per_unit = *unit;
        } else if (word.key == "up") {
            try {
                frame.up = parse_up_axis(word.value);
            } catch (const Error&) {
                throw wrong("one of: x y z -x -y -z");
            }
        } else if (word.key == "tilt") {
            const std::optional<std::vector<double>> n = read_numbers(word.value, ',', 3);
            if (!n || !is_tilt({(*n)[0], (*n)[1], (*n)[2]}))
                throw wrong("three numbers x,y,z, together less than 1");
            frame.tilt = {(*n)[0], (*n)[1], (*n)[2]};
        } else {
            throw CommandError("'frame' takes no '" + word.key + "'; it takes origin unit up tilt.",
                               word.column);
        }
    }
    return frame;
}

// The version that a log's first line tells; nothing for another line.
std::optional<int> version_of(std::string_view line) {
    if (!line.starts_with(kHeader)) return std::nullopt;
    const std::string_view text = line.substr(kHeader.size());
    int version = 0;
    std::from_chars(text.data(), text.data() + text.size(), version);
    return version;
}

// Where the line ends that the text begins with: not within quotes, so that a text may have several lines.
// A quote that never ends makes no more than its own line wrong.
size_t end_of_line(std::string_view text) {
    const size_t first = text.find('\n');
    if (text.substr(0, first).find('"') == std::string_view::npos) return first;
    bool quoted = false;
    for (size_t at = text.starts_with(kUnfit) ? kUnfit.size() : 0; at < text.size(); at++) {
        if (text[at] == '"') quoted = !quoted;
        if (quoted) continue;
        if (text[at] == '\n') return at;
        if (text[at] == '#') return text.find('\n', at);
    }
    return first;
}

// Splits off the next line, without its end.
std::string_view take_line(std::string_view& text) {
    const size_t end = end_of_line(text);
    std::string_view line = text.substr(0, end);
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
    while (!line.empty() && line.back() == '\r')
        line.remove_suffix(1);
    return line;
}

size_t lines_in(std::string_view text) {
    return 1 + static_cast<size_t>(std::count(text.begin(), text.end(), '\n'));
}

std::string place_of(size_t line, size_t column) {
    return "Line " + std::to_string(line) + ", column " + std::to_string(column) + ": ";
}

}  // namespace

void EditLog::remove_last(size_t count) {
    entries_.resize(entries_.size() - std::min(count, entries_.size()));
}

std::string EditLog::text() const {
    std::string text = newer_.empty() ? std::string(kHeader) + std::to_string(kLogVersion) + "\n" : newer_;
    const ScanFrame* frame = nullptr;
    for (const Entry& entry : entries_) {
        if (!frame || !(*frame == entry.frame)) text += frame_line(entry.frame) + "\n";
        frame = &entry.frame;
        if (entry.fits()) {
            text += entry.command + "\n";
            continue;
        }
        text += std::string(kReason) + entry.reason + "\n";
        text += std::string(kUnfit) + entry.command + "\n";
    }
    return text;
}

EditLog EditLog::parse(std::string_view text) {
    EditLog log;
    ScanFrame frame;
    std::string reason;
    size_t number = 0, lines = 1;
    for (std::string_view rest = text; !rest.empty();) {
        const std::string_view line = take_line(rest);
        number += lines;
        lines = lines_in(line);
        if (version_of(line).value_or(0) > kLogVersion) {
            log.entries_.clear();
            log.newer_ = text;
            if (!log.newer_.ends_with('\n')) log.newer_ += '\n';
            return log;
        }
        if (line.starts_with(kReason)) {
            reason = line.substr(kReason.size());
            continue;
        }
        if (line.starts_with(kUnfit)) {
            log.add({std::string(line.substr(kUnfit.size())), frame,
                     reason.empty() ? "It did not fit." : reason});
            reason.clear();
            continue;
        }
        const size_t first = line.find_first_not_of(" \t\r");
        if (first == std::string_view::npos || line[first] == '#') continue;
        if (line.substr(first, 6) != "frame ") {
            log.add({std::string(line), frame, ""});
            continue;
        }
        try {
            frame = parse_frame(*parse_command_line(line));
        } catch (const CommandError& error) {
            throw Error(place_of(number, error.column()) + error.what());
        }
    }
    return log;
}

ScriptResult run_script(Tree& tree, std::string_view script, const ScriptOptions& options) {
    ScriptResult result;
    Tree now = tree;
    std::optional<ScanFrame> written_in;
    size_t number = 0, lines = 1;
    std::string_view rest = script;
    while (!rest.empty()) {
        std::string_view text = take_line(rest);
        number += lines;
        lines = lines_in(text);
        if (options.progress)
            options.progress->update(
                1.0 - static_cast<double>(rest.size()) / static_cast<double>(script.size()), "Editing");
        if (options.progress) options.progress->check();
        if (version_of(text).value_or(0) > kLogVersion)
            throw Error("This log was written by a newer version (" + std::to_string(*version_of(text)) +
                        "; this one reads up to " + std::to_string(kLogVersion) + "). Update to replay it.");
        if (options.keep_going && text.starts_with(kUnfit)) text.remove_prefix(kUnfit.size());
        bool frame_line = false;
        const auto leave_out = [&](const std::string& reason) {
            result.left_out.push_back({number, std::string(text), reason});
            result.log.add({std::string(text), written_in ? *written_in : now.frame(), reason});
        };
        try {
            const std::optional<CommandLine> line = parse_command_line(text);
            if (!line) continue;
            frame_line = line->name == "frame";
            if (frame_line) {
                written_in = parse_frame(*line);
                continue;
            }
            BindOptions bind;
            bind.tolerance = options.tolerance;
            bind.written_in = written_in ? &*written_in : nullptr;
            bind.progress = options.progress;
            bind.keep_going = options.keep_going;
            // A script that fails is given up, so that no command needs a way back; one that goes on does.
            const std::optional<Tree> before = options.keep_going ? std::optional(now) : std::nullopt;
            Edit edit;
            try {
                edit = perform_for_good(now, text, bind);
            } catch (const Error&) {
                if (before) now = *before;
                throw;
            }
            result.done++;
            result.log.add(edit);
            if (edit.missing > 0)
                result.in_part.push_back({number, std::string(text),
                                          std::to_string(edit.missing) + " of " + std::to_string(edit.named) +
                                              " places are not there any more."});
            if (!edit.outcome.said.empty()) result.said.push_back(edit.outcome.said);
        } catch (const Cancelled&) {
            throw;
        } catch (const CommandError& error) {
            if (!options.keep_going || frame_line)
                throw Error(place_of(number, error.column()) + error.what());
            leave_out(error.what());
        } catch (const Error& error) {
            if (!options.keep_going)
                throw Error(place_of(number, text.find_first_not_of(" \t") + 1) + error.what());
            leave_out(error.what());
        }
    }
    result.delta = TreeDelta::between(tree, now);
    tree = std::move(now);
    return result;
}

}  // namespace treerec
