#include "scan/plots/cloud_pieces.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "error.h"
#include "file_bytes.h"
#include "ply_header.h"

namespace treerec {

namespace {

// ASPRS, "LAS Specification 1.4 - R15", section 2.4.
constexpr size_t kOldHeader = 227, kLongHeader = 375;
constexpr size_t kPlaceOfData = 96, kPlaceOfFormat = 104, kPlaceOfStride = 105, kPlaceOfCount = 107;
constexpr size_t kPlaceOfExtended = 235, kPlaceOfLongCount = 247;
constexpr uint64_t kMostRecords = uint64_t{1} << 26;  // bytes beside the points
constexpr size_t kMostWarnings = 20;

template <typename T>
T little(const std::string& bytes, size_t at) {
    return load_value<T>(bytes.data() + at, std::endian::native != std::endian::little);
}

template <typename T>
void put_little(std::string& bytes, size_t at, T value) {
    for (size_t k = 0; k < sizeof(T); k++)
        bytes[at + k] = static_cast<char>(static_cast<uint64_t>(value) >> (8 * k) & 0xFF);
}

std::string read_at(std::ifstream& stream, uint64_t at, uint64_t size) {
    std::string bytes(size, '\0');
    stream.seekg(static_cast<std::streamoff>(at));
    stream.read(bytes.data(), static_cast<std::streamsize>(size));
    bytes.resize(static_cast<size_t>(stream.gcount()));
    stream.clear();
    return bytes;
}

bool has_long_header(const std::string& begin) {
    return begin[24] == 1 && begin[25] >= 4 && begin.size() >= kLongHeader;
}

}  // namespace

CloudPieces::CloudPieces(std::string path, ReadCloudOptions options, size_t piece, Progress* progress)
    : path_(std::move(path)), options_(std::move(options)), piece_(piece) {
    find_records(piece);
    if (records_) return;
    ReadCloudReport report;
    whole_ = read_cloud(path_, options_, &report, progress);
    take_warnings(report);
}

// None where the file is small or anything about it is odd: the reader of whole files then says what.
void CloudPieces::find_records(size_t piece) {
    std::error_code failure;
    const uint64_t size = std::filesystem::file_size(path_of(path_), failure);
    if (failure || size < kLongHeader) return;
    std::ifstream stream(path_of(path_), std::ios::binary);
    Records found;
    found.begin = read_at(stream, 0, kLongHeader);
    if (found.begin.size() < kLongHeader || !found.begin.starts_with("LASF")) return;
    const bool compressed = (found.begin[kPlaceOfFormat] & 0xC0) != 0;
    found.data = little<uint32_t>(found.begin, kPlaceOfData);
    found.stride = little<uint16_t>(found.begin, kPlaceOfStride);
    found.count = little<uint32_t>(found.begin, kPlaceOfCount);
    if (compressed || found.stride == 0 || found.data < kOldHeader || found.data > kMostRecords) return;
    const bool long_header = has_long_header(found.begin);
    uint64_t extended = 0;
    if (long_header) {
        if (const auto count = little<uint64_t>(found.begin, kPlaceOfLongCount)) found.count = count;
        extended = little<uint64_t>(found.begin, kPlaceOfExtended);
    }
    if (found.count <= piece || found.data > size || (size - found.data) / found.stride < found.count) return;
    found.begin = read_at(stream, 0, found.data);
    if (extended > 0) {
        if (extended < found.data + found.count * found.stride || extended > size ||
            size - extended > kMostRecords)
            return;
        found.end = read_at(stream, extended, size - extended);
    }
    records_ = std::move(found);
}

std::string CloudPieces::file_of(std::ifstream& stream, uint64_t first, uint64_t count) const {
    std::string bytes = records_->begin;
    const std::string points =
        read_at(stream, records_->data + first * records_->stride, count * records_->stride);
    if (points.size() != count * records_->stride)
        throw Error("'" + path_ + "' could not be read to its end; copy it again.");
    const bool small = count <= 0xFFFFFFFFU;
    put_little(bytes, kPlaceOfCount, static_cast<uint32_t>(small ? count : 0));
    if (has_long_header(bytes)) {
        put_little(bytes, kPlaceOfLongCount, count);
        if (!records_->end.empty()) put_little(bytes, kPlaceOfExtended, bytes.size() + points.size());
    }
    return bytes + points + records_->end;
}

void CloudPieces::each(const std::function<void(const PointCloud&)>& take, Progress* progress) {
    if (!records_) return take(whole_);
    std::ifstream stream(path_of(path_), std::ios::binary);
    if (!stream) throw Error("'" + path_ + "' cannot be opened any more.");
    std::optional<Error> refused;
    bool any = false;
    for (uint64_t first = 0; first < records_->count; first += piece_) {
        if (progress) {
            progress->check();
            progress->update(static_cast<double>(first) / static_cast<double>(records_->count), "Reading");
        }
        const uint64_t count = std::min<uint64_t>(piece_, records_->count - first);
        ReadCloudReport report;
        PointCloud piece;
        try {
            piece = read_cloud_bytes(path_, file_of(stream, first, count), options_, &report);
        } catch (const Error& error) {
            // It may hold nothing but noise, or none of the classes that are wanted.
            if (!refused) refused = error;
            continue;
        }
        any = true;
        take_warnings(report);
        take(piece);
    }
    if (!any && refused) throw Error(*refused);
    if (refused) take_warnings({"", {std::string("Points were left out: ") + refused->what()}});
}

void CloudPieces::take_warnings(const ReadCloudReport& report) {
    for (const std::string& warning : report.warnings)
        if (warnings_.size() < kMostWarnings &&
            std::find(warnings_.begin(), warnings_.end(), warning) == warnings_.end())
            warnings_.push_back(warning);
}

}  // namespace treerec
