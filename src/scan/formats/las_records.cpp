#include "scan/formats/las_records.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>

#include "scan/formats/wkt.h"

namespace treerec {

namespace {

constexpr bool kSwap = std::endian::native != std::endian::little;
constexpr double kSurveyFoot = 1200.0 / 3937.0;

// The GeoTIFF specification's numbers (OGC 19-008r4, annex B; EPSG's units of measure).
constexpr uint16_t kKeyModel = 1024;
constexpr uint16_t kKeyProjected = 3072;
constexpr uint16_t kKeyLinearUnit = 3076;
constexpr uint16_t kKeyLinearUnitSize = 3077;
constexpr uint16_t kKeyVerticalUnit = 4099;
constexpr uint16_t kModelGeographic = 2;
constexpr uint16_t kUserDefined = 32767;

struct KnownUnit {
    uint16_t code;
    double metres;
};
constexpr KnownUnit kKnownUnits[] = {
    {9001, 1.0},    {9002, 0.3048},       {9003, kSurveyFoot}, {9005, 0.3047972654}, {9014, 1.8288},
    {9030, 1852.0}, {9036, 1000.0},       {9093, 1609.344},    {9096, 0.9144},       {1025, 0.001},
    {1033, 0.01},   {9041, 0.3048007491}, {9070, 0.3048},      {9084, 0.91439853},   {9094, 0.3047997101816}};

bool is_length(double metres) {
    return metres > 1e-6 && metres < 1e6;
}

double metres_of_code(uint16_t code) {
    for (const KnownUnit& unit : kKnownUnits)
        if (unit.code == code) return unit.metres;
    return 0.0;
}

std::string name_of(double metres) {
    const auto is = [&](double other) { return std::abs(metres / other - 1.0) < 1e-7; };
    if (is(1.0)) return "metres";
    if (is(kSurveyFoot)) return "US survey feet";
    if (is(0.3048)) return "feet";
    if (is(0.01)) return "centimetres";
    if (is(0.001)) return "millimetres";
    char text[32];
    const std::to_chars_result end =
        std::to_chars(text, text + sizeof text, metres, std::chars_format::general, 7);
    return "units of " + std::string(text, end.ptr) + " m";
}

// What a file says in one of its ways. 0: nothing.
struct Told {
    double plan = 0.0;
    double height = 0.0;
    bool degrees = false;
    bool named = false;  // a coordinate system is named
    uint16_t epsg = 0;
};

uint16_t short_at(std::string_view bytes, size_t at) {
    return load_value<uint16_t>(bytes.data() + at, kSwap);
}

Told told_by_keys(std::string_view directory, std::string_view doubles) {
    Told told;
    if (directory.size() < 8) return told;
    const size_t keys = std::min<size_t>(short_at(directory, 6), directory.size() / 8 - 1);
    uint16_t linear = 0, vertical = 0;
    double size = 0.0;
    for (size_t i = 1; i <= keys; i++) {
        const uint16_t key = short_at(directory, 8 * i);
        const uint16_t where = short_at(directory, 8 * i + 2);
        const uint16_t value = short_at(directory, 8 * i + 6);
        if (key == kKeyLinearUnitSize && where == 34736 && doubles.size() / 8 > value)
            size = load_value<double>(doubles.data() + size_t{8} * value, kSwap);
        if (where != 0) continue;
        if (key == kKeyModel) told.degrees = value == kModelGeographic;
        if (key == kKeyProjected) told.epsg = value;
        if (key == kKeyLinearUnit) linear = value;
        if (key == kKeyVerticalUnit) vertical = value;
    }
    told.named = told.epsg != 0;
    told.plan = linear == kUserDefined ? size : metres_of_code(linear);
    told.height = metres_of_code(vertical);
    return told;
}

Told told_by_wkt(std::string_view text) {
    const WktUnits units = wkt_units(text);
    return {units.plan, units.height, units.degrees, units.named, 0};
}

// The zones of UTM, which are in metres.
bool is_metric_epsg(uint16_t code) {
    const auto within = [&](uint16_t first, uint16_t last) { return code >= first && code <= last; };
    return within(32601, 32660) || within(32701, 32760) || within(25828, 25838) || within(26901, 26923) ||
           within(3034, 3035) || within(23028, 23038);
}

}  // namespace

std::vector<LasRecord> las_records(std::string_view bytes) {
    std::vector<LasRecord> records;
    const auto gather = [&](size_t at, uint32_t count, size_t end, bool extended) {
        const size_t head = extended ? 60 : 54;
        for (; count > 0 && at <= end && end - at >= head; count--) {
            std::string_view user = bytes.substr(at + 2, 16);
            user = user.substr(0, user.find('\0'));
            const uint64_t length = extended ? load_value<uint64_t>(bytes.data() + at + 20, kSwap)
                                             : load_value<uint16_t>(bytes.data() + at + 20, kSwap);
            if (length > end - at - head) return;
            records.push_back({user, load_value<uint16_t>(bytes.data() + at + 18, kSwap),
                               bytes.substr(at + head, static_cast<size_t>(length))});
            at += head + static_cast<size_t>(length);
        }
    };
    const size_t data = std::min<size_t>(load_value<uint32_t>(bytes.data() + 96, kSwap), bytes.size());
    gather(load_value<uint16_t>(bytes.data() + 94, kSwap), load_value<uint32_t>(bytes.data() + 100, kSwap),
           data, false);
    if (bytes[25] >= 4 && bytes.size() >= 375) {
        const uint64_t begin = load_value<uint64_t>(bytes.data() + 235, kSwap);
        if (begin > data && begin < bytes.size())
            gather(static_cast<size_t>(begin), load_value<uint32_t>(bytes.data() + 243, kSwap), bytes.size(),
                   true);
    }
    return records;
}

LasUnits las_units(std::string_view bytes) {
    constexpr uint16_t kWktBit = 0x10;  // of the global encoding
    std::string_view wkt, directory, doubles;
    for (const LasRecord& record : las_records(bytes)) {
        if (record.user != "LASF_Projection") continue;
        if (record.id == 2112) wkt = record.bytes;
        if (record.id == 34735) directory = record.bytes;
        if (record.id == 34736) doubles = record.bytes;
    }
    const Told by_wkt = told_by_wkt(wkt), by_keys = told_by_keys(directory, doubles);
    const bool wkt_first = (short_at(bytes, 6) & kWktBit) != 0 || !by_keys.named;
    const Told& first = wkt_first ? by_wkt : by_keys;
    const Told& second = wkt_first ? by_keys : by_wkt;
    Told told = is_length(first.plan) || is_length(first.height) ? first : second;
    told.degrees = first.degrees || (!first.named && second.degrees);

    LasUnits units;
    units.degrees = told.degrees;
    const bool has_plan = is_length(told.plan), has_height = is_length(told.height);
    units.unit.metres = has_plan ? told.plan : has_height ? told.height : 1.0;
    units.unit.assumed = !has_plan;
    if (has_plan || has_height) units.name = name_of(units.unit.metres);
    if (has_plan && has_height && std::abs(told.height / told.plan - 1.0) > 1e-9) {
        units.height_factor = told.height / told.plan;
        units.height_name = name_of(told.height);
    }
    const uint16_t epsg = by_keys.epsg;
    const bool named = by_wkt.named || by_keys.named;
    if (has_plan || has_height || !named || units.degrees || is_metric_epsg(epsg)) return units;
    const std::string system = epsg != 0 && epsg != kUserDefined
                                   ? "by its number alone, EPSG:" + std::to_string(epsg)
                                   : "without its unit";
    units.unit.doubt = "The file names its coordinate system " + system +
                       "; its units were taken for metres. If they are feet, set the unit (--unit us-ft or "
                       "--unit ft; in the Import dock: Unit).";
    return units;
}

std::vector<LasExtraField> las_extra_fields(std::string_view bytes) {
    constexpr size_t kDescription = 192;
    constexpr PlyType kTypes[] = {PlyType::kUint8,  PlyType::kInt8,  PlyType::kUint16, PlyType::kInt16,
                                  PlyType::kUint32, PlyType::kInt32, PlyType::kUint64, PlyType::kInt64,
                                  PlyType::kFloat,  PlyType::kDouble};
    std::vector<LasExtraField> fields;
    for (const LasRecord& record : las_records(bytes)) {
        if (record.user != "LASF_Spec" || record.id != 4) continue;
        size_t offset = 0;
        for (size_t at = 0; record.bytes.size() - at >= kDescription; at += kDescription) {
            const size_t type = static_cast<unsigned char>(record.bytes[at + 2]);
            if (type == 0) {
                offset += static_cast<unsigned char>(record.bytes[at + 3]);
                continue;
            }
            // 11 to 30: two or three of a type.
            const size_t kind = (type - 1) % 10, values = (type - 1) / 10 + 1;
            if (type > 30) break;
            std::string_view name = record.bytes.substr(at + 4, 32);
            name = name.substr(0, name.find('\0'));
            if (values == 1) fields.push_back({std::string(name), kTypes[kind], offset});
            offset += values * size_of(kTypes[kind]);
        }
        break;
    }
    return fields;
}

}  // namespace treerec
