#include "edit/script.h"

#include <charconv>
#include <optional>

#include "edit/address.h"
#include "edit/command_text.h"

namespace treerec {

namespace {

constexpr std::string_view kHeader = "# treerec edit log ";
constexpr int kLogVersion = 1;
constexpr std::string_view kUnfit = "#? ";

std::string frame_line(const ScanFrame& frame) {
    std::string line = "frame";
    append_word(line, "origin", vector_text(frame.origin));
    append_word(line, "unit", number_text(frame.metres_per_unit));
    append_word(line, "up", up_axis_name(frame.up));
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
        } else {
            throw CommandError("'frame' takes no '" + word.key + "'; it takes origin unit up.", word.column);
        }
    }
    return frame;
}

void check_header(std::string_view line) {
    if (!line.starts_with(kHeader)) return;
    const std::string_view text = line.substr(kHeader.size());
    int version = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), version);
    if (failure != std::errc() || version > kLogVersion)
        throw Error("This log was written by a newer version (" + quote_word(text) +
                    "; this one reads up to " + std::to_string(kLogVersion) + "). Update to replay it.");
}

std::string place_of(size_t line, size_t column) {
    return "Line " + std::to_string(line) + ", column " + std::to_string(column) + ": ";
}

}  // namespace

void EditLog::forget_last() {
    for (size_t i = entries_.size(); i-- > 0;) {
        if (!entries_[i].fits()) continue;
        entries_.erase(entries_.begin() + static_cast<std::ptrdiff_t>(i));
        return;
    }
}

std::string EditLog::text() const {
    std::string text = std::string(kHeader) + std::to_string(kLogVersion) + "\n";
    const ScanFrame* frame = nullptr;
    for (const Entry& entry : entries_) {
        if (!frame || !(*frame == entry.frame)) text += frame_line(entry.frame) + "\n";
        frame = &entry.frame;
        if (entry.fits()) {
            text += entry.command + "\n";
            continue;
        }
        text += "# This did not fit: " + entry.reason + "\n";
        text += std::string(kUnfit) + entry.command + "\n";
    }
    return text;
}

ScriptResult run_script(Tree& tree, std::string_view script, const ScriptOptions& options) {
    ScriptResult result;
    Tree now = tree;
    std::optional<ScanFrame> written_in;
    size_t number = 0;
    std::string_view rest = script;
    while (!rest.empty()) {
        number++;
        const size_t end = rest.find('\n');
        std::string_view text = rest.substr(0, end);
        rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
        if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
        if (options.progress) options.progress->check();
        check_header(text);
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
            const Edit edit = perform(now, text, bind);
            result.done++;
            result.log.add(edit);
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
