#include "photos/colmap_job.h"

#include <algorithm>
#include <charconv>
#include <ctime>

#include "error.h"
#include "file_bytes.h"

namespace treerec {

namespace {

constexpr size_t kLastLines = 6;

// Without what a terminal would obey.
std::string plain(const std::string& line) {
    std::string text;
    for (const char c : line.substr(0, 200))
        text += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    return text;
}

std::string now() {
    const std::time_t time = std::time(nullptr);
    char text[32] = {};
    std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S UTC", std::gmtime(&time));
    return text;
}

bool take_number(const std::string& line, size_t& at, size_t& value) {
    const auto [end, failure] = std::from_chars(line.data() + at, line.data() + line.size(), value);
    if (failure != std::errc()) return false;
    at = static_cast<size_t>(end - line.data());
    return true;
}

bool take_fraction(const std::string& line, size_t& at, size_t& done, size_t& all) {
    if (!take_number(line, at, done) || at >= line.size() || line[at] != '/') return false;
    return take_number(line, ++at, all);
}

}  // namespace

ColmapJob::ColmapJob(Colmap colmap, const std::string& log, FolderLock& lock, Progress* progress)
    : colmap_(std::move(colmap)),
      log_path_(log),
      log_(path_of(log), std::ios::binary | std::ios::app),
      lock_(lock),
      progress_(progress) {
    if (!log_) throw Error("'" + log + "' cannot be written; check that its folder is yours to write.");
    note("== " + now() + ", COLMAP " + colmap_.version() + " at " + colmap_.program());
}

void ColmapJob::set(std::vector<std::string>& words, const std::string& command, const OptionNames& names,
                    const std::string& value) {
    for (const char* name : names) {
        if (!colmap_.knows(command, name, progress_)) continue;
        words.emplace_back(name);
        words.push_back(value);
        return;
    }
}

ColmapEnd ColmapJob::run(const ColmapCall& call, const std::function<void(const std::string&)>& on_line) {
    ChildCommand command = colmap_.call(call.command);
    command.lock = &lock_;
    for (const auto* words : {&call.places, &call.settings})
        command.arguments.insert(command.arguments.end(), words->begin(), words->end());
    std::string told = "$";
    for (const std::string& word : command.arguments)
        told += " " + word;
    note(told);
    ColmapEnd result;
    result.end = run_child(
        command,
        [&](const std::string& line) {
            note(line);
            if (line.find_first_not_of(" \t=") != std::string::npos) {
                result.last_lines.push_back(plain(line));
                if (result.last_lines.size() > kLastLines) result.last_lines.pop_front();
            }
            on_line(line);
        },
        progress_);
    if (!result.end.well())
        note("-- ended with " + (result.end.signal ? "signal " + std::to_string(result.end.signal)
                                                   : "exit code " + std::to_string(result.end.code)));
    return result;
}

void ColmapJob::note(const std::string& line) {
    // A full disk does not end the work; COLMAP itself will say so.
    log_ << line << '\n' << std::flush;
}

Error ColmapJob::failure(const ColmapCall& call, const ColmapEnd& end) const {
    std::string text = "COLMAP's " + call.command;
    if (end.end.signal == 9)
        text +=
            " was ended from outside (signal 9), perhaps for want of memory: close other programs, or "
            "take a shorter time (quick).";
    else if (end.end.signal != 0)
        text += " crashed (signal " + std::to_string(end.end.signal) + ").";
    else
        text += " ended with exit code " + std::to_string(end.end.code) + ".";
    text += " All that it said is in '" + log_path_ + "'";
    if (end.last_lines.empty()) return Error(text + ".");
    text += "; its last lines:";
    for (const std::string& line : end.last_lines)
        text += "\n    " + line;
    return Error(text);
}

CountInLine count_in(const std::string& line) {
    for (size_t at = line.find('['); at != std::string::npos; at = line.find('[', at)) {
        CountInLine count;
        if (!take_fraction(line, ++at, count.done, count.all) || at >= line.size()) continue;
        if (line[at] == ']') return count;
        size_t done = 0, all = 0;
        if (line.compare(at, 2, ", ") != 0 || !take_fraction(line, at += 2, done, all)) continue;
        if (at < line.size() && line[at] == ']' && count.done > 0)
            return {(count.done - 1) * all + done, count.all * all};
    }
    return {};
}

size_t number_after(const std::string& line, const std::string& word) {
    size_t at = line.find(word);
    if (at == std::string::npos) return 0;
    at = line.find_first_of("0123456789", at + word.size());
    size_t value = 0;
    return at != std::string::npos && take_number(line, at, value) ? value : 0;
}

}  // namespace treerec
