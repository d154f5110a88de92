#include "photos/run_stage.h"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "file_bytes.h"

namespace treerec {

using json = nlohmann::json;

namespace {

// A damaged mark is none.
json read_mark(const std::string& path) {
    std::error_code failure;
    if (!std::filesystem::is_regular_file(path_of(path), failure)) return {};
    const FileBytes bytes = read_file(path);
    return json::parse(bytes.view(), nullptr, false);
}

}  // namespace

std::string photos_as_text(const PhotoFolder& photos) {
    json list = json::array();
    for (const PhotoFile& photo : photos.photos)
        list.push_back({photo.name, photo.bytes, photo.written});
    // Names that are no UTF-8 are possible on Linux.
    return list.dump(-1, ' ', false, json::error_handler_t::replace);
}

RunStage::RunStage(const std::string& path, const std::string& basis) : path_(path), basis_(basis) {
    const json mark = read_mark(path);
    if (!mark.is_object() || mark.value("basis", json()) != json(basis)) return;
    begun_ = true;
    done_ = mark.value("done", json()) == json(true);
    const json note = mark.value("note", json());
    if (note.is_string()) note_ = note.get<std::string>();
}

void RunStage::begin(const std::string& note) {
    begun_ = true;
    done_ = false;
    note_ = note;
    write();
}

void RunStage::finish(const std::string& note) {
    done_ = true;
    note_ = note;
    write();
}

void RunStage::write() {
    const json mark = {{"basis", basis_}, {"done", done_}, {"note", note_}};
    write_file(path_, mark.dump(1, ' ', false, json::error_handler_t::replace) + "\n");
}

}  // namespace treerec
