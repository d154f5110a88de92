#include "scan/formats/readers.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <mutex>
#include <span>
#include <utility>

#include "geometry/parallel.h"
#include "geometry/portable_math.h"

namespace treerec {

namespace {

// Lower case, letters and digits alone.
std::string plain(std::string_view name) {
    std::string result;
    for (const char c : name) {
        if (c >= 'A' && c <= 'Z') result += static_cast<char>(c - 'A' + 'a');
        if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) result += c;
    }
    return result;
}

struct NameRole {
    std::string_view name;
    Role role;
};

// Plain spellings. The sure names come first; the others count only where no sure name took the role.
constexpr NameRole kSureNames[] = {
    {"x", kRoleX},           {"y", kRoleY},        {"z", kRoleZ},          {"red", kRoleR},
    {"green", kRoleG},       {"blue", kRoleB},     {"diffusered", kRoleR}, {"diffusegreen", kRoleG},
    {"diffuseblue", kRoleB}, {"nx", kRoleNx},      {"ny", kRoleNy},        {"nz", kRoleNz},
    {"normalx", kRoleNx},    {"normaly", kRoleNy}, {"normalz", kRoleNz},   {"woodradius", kRoleRadius},
};
// Of labels: those whose name says which value is the leaf go before the others.
constexpr std::string_view kLeafNames[] = {"foliage",    "leaf",         "leaves",
                                           "isleaf",     "leafbycolour", "scalarfoliage",
                                           "scalarleaf", "scalarleaves", "scalarisleaf"};
constexpr std::string_view kWoodNames[] = {"wood", "iswood", "scalarwood", "scalariswood"};
constexpr std::string_view kLabelNames[] = {
    "classification",       "label",       "labels",           "leafwood", "woodleaf",
    "scalarclassification", "scalarlabel", "scalarlabels",     "class",    "scalarclass",
    "prediction",           "predlabel",   "scalarprediction",
};
constexpr NameRole kLikelyNames[] = {
    {"r", kRoleR},           {"g", kRoleG},           {"b", kRoleB},         {"rf", kRoleR},
    {"gf", kRoleG},          {"bf", kRoleB},          {"coordx", kRoleX},    {"coordy", kRoleY},
    {"coordz", kRoleZ},      {"xcoord", kRoleX},      {"ycoord", kRoleY},    {"zcoord", kRoleZ},
    {"posx", kRoleX},        {"posy", kRoleY},        {"posz", kRoleZ},      {"px", kRoleX},
    {"py", kRoleY},          {"pz", kRoleZ},          {"xm", kRoleX},        {"ym", kRoleY},
    {"zm", kRoleZ},          {"positionx", kRoleX},   {"positiony", kRoleY}, {"positionz", kRoleZ},
    {"points0", kRoleX},     {"points1", kRoleY},     {"points2", kRoleZ},   {"xcoordinate", kRoleX},
    {"ycoordinate", kRoleY}, {"zcoordinate", kRoleZ}, {"easting", kRoleX},   {"northing", kRoleY},
    {"east", kRoleX},        {"north", kRoleY},       {"elevation", kRoleZ}, {"altitude", kRoleZ},
    {"height", kRoleZ},      {"normals0", kRoleNx},   {"normals1", kRoleNy}, {"normals2", kRoleNz},
};

}  // namespace

std::vector<int8_t> roles_from_names(const std::vector<std::string>& names) {
    std::vector<int8_t> roles(names.size(), kNoRole);
    std::array<bool, kRoleCount> taken{};
    auto take = [&](const std::vector<std::string>& plain_names, const auto& table) {
        for (size_t i = 0; i < plain_names.size(); i++) {
            for (const NameRole& entry : table) {
                if (roles[i] != kNoRole || taken[entry.role] || plain_names[i] != entry.name) continue;
                roles[i] = entry.role;
                taken[entry.role] = true;
            }
        }
    };
    std::vector<std::string> plain_names;
    for (const std::string& name : names)
        plain_names.push_back(plain(name));
    take(plain_names, kSureNames);
    take(plain_names, kLikelyNames);
    const auto take_label = [&](std::span<const std::string_view> known) {
        for (size_t i = 0; i < plain_names.size(); i++)
            for (const std::string_view name : known) {
                if (roles[i] != kNoRole || taken[kRoleLabel] || plain_names[i] != name) continue;
                roles[i] = kRoleLabel;
                taken[kRoleLabel] = true;
            }
    };
    take_label(kLeafNames);
    take_label(kWoodNames);
    take_label(kLabelNames);
    for (const int first : {kRoleR, kRoleNx}) {
        if (taken[first] && taken[first + 1] && taken[first + 2]) continue;
        for (int8_t& role : roles)
            if (role >= first && role < first + 3) role = kNoRole;
    }
    return roles;
}

LabelMeaning label_meaning(std::string_view name) {
    const std::string plain_name = plain(name);
    const auto is_one_of = [&](std::span<const std::string_view> known) {
        return std::find(known.begin(), known.end(), plain_name) != known.end();
    };
    if (is_one_of(kLeafNames)) return LabelMeaning::kLeaf;
    return is_one_of(kWoodNames) ? LabelMeaning::kWood : LabelMeaning::kEither;
}

bool is_label_by_colour(std::string_view name) {
    return plain(name) == "leafbycolour";
}

double label_of_word(std::string_view word) {
    const std::string plain_word = plain(word);
    for (const std::string_view leaf : {"leaf", "leaves", "foliage", "needle", "needles"})
        if (plain_word == leaf) return kLeafWord;
    for (const std::string_view wood :
         {"wood", "woody", "stem", "trunk", "branch", "branches", "bark", "twig", "twigs"})
        if (plain_word == wood) return kWoodWord;
    return std::numeric_limits<double>::quiet_NaN();
}

bool has_role(const std::vector<int8_t>& roles, Role role) {
    for (const int8_t r : roles)
        if (r == role) return true;
    return false;
}

std::string describe_roles(const std::vector<int8_t>& roles) {
    static constexpr const char* kNames[] = {"x",  "y",  "z",  "r",       "g",     "b",
                                             "nx", "ny", "nz", "opacity", "label", "wood_radius"};
    std::string text;
    for (const int8_t role : roles)
        text += std::string(text.empty() ? "" : " ") + (role == kNoRole ? "-" : kNames[role]);
    return text;
}

void ReadJob::fail(const std::string& rest) const {
    throw Error("'" + path + "' " + rest);
}

void ReadJob::step(double fraction) const {
    if (!progress) return;
    progress->check();
    progress->update(fraction, "Reading");
}

void ReadJob::parallel(size_t count, size_t grain, double begin, double end,
                       const std::function<void(size_t, size_t)>& body) const {
    std::mutex mutex;  // progress never falls, and is asked by one thread at a time
    size_t done = 0;
    parallel_for(count, grain, [&](size_t from, size_t to) {
        body(from, to);
        const std::lock_guard lock(mutex);
        done += to - from;
        step(begin + (end - begin) * static_cast<double>(done) / static_cast<double>(count));
    });
}

void make_room(const ReadJob& job, RawCloud& raw, size_t count, const std::vector<int8_t>& roles) {
    make_room(job, raw.positions, count);
    if (has_role(roles, kRoleR)) make_room(job, raw.colors, count);
    if (has_role(roles, kRoleNx)) make_room(job, raw.normals, count);
    if (has_role(roles, kRoleOpacity)) make_room(job, raw.opacities, count);
    if (has_role(roles, kRoleLabel)) make_room(job, raw.labels, count);
    if (has_role(roles, kRoleRadius)) make_room(job, raw.radii, count);
}

void RawCloud::reserve(size_t count, const std::vector<int8_t>& roles) {
    positions.reserve(count);
    if (has_role(roles, kRoleR)) colors.reserve(count);
    if (has_role(roles, kRoleNx)) normals.reserve(count);
    if (has_role(roles, kRoleOpacity)) opacities.reserve(count);
    if (has_role(roles, kRoleLabel)) labels.reserve(count);
    if (has_role(roles, kRoleRadius)) radii.reserve(count);
}

void RawCloud::add(const std::array<double, kRoleCount>& row, const std::vector<int8_t>& roles) {
    positions.emplace_back(row[kRoleX], row[kRoleY], row[kRoleZ]);
    if (has_role(roles, kRoleR)) colors.emplace_back(row[kRoleR], row[kRoleG], row[kRoleB]);
    if (has_role(roles, kRoleNx)) normals.emplace_back(row[kRoleNx], row[kRoleNy], row[kRoleNz]);
    if (has_role(roles, kRoleOpacity)) opacities.push_back(static_cast<float>(row[kRoleOpacity]));
    if (has_role(roles, kRoleLabel)) labels.push_back(static_cast<float>(row[kRoleLabel]));
    if (has_role(roles, kRoleRadius)) radii.push_back(static_cast<float>(row[kRoleRadius]));
}

size_t RawCloud::keep_only(const std::vector<uint8_t>& keep) {
    const size_t before = positions.size();
    const auto compact = [&](auto& values) {
        if (values.empty()) return;
        size_t kept = 0;
        for (size_t i = 0; i < values.size(); i++)
            if (keep[i]) values[kept++] = values[i];
        values.resize(kept);
    };
    compact(positions);
    compact(colors);
    compact(normals);
    compact(opacities);
    compact(labels);
    compact(radii);
    return before - positions.size();
}

namespace {

template <typename Target>
void decode_values(const ValueColumn& column, size_t count, Target* target, size_t step) {
    with_ply_type(column.type, [&](auto t) {
        using T = decltype(t);
        const char* p = column.first;
        if (column.swap) {
            for (size_t i = 0; i < count; i++, p += column.stride)
                target[step * i] = static_cast<Target>(load_value<T>(p, true));
        } else {
            for (size_t i = 0; i < count; i++, p += column.stride)
                target[step * i] = static_cast<Target>(load_value<T>(p, false));
        }
    });
}

}  // namespace

void decode_column(const ValueColumn& column, size_t count, int8_t role, size_t begin, RawCloud& raw) {
    if (role == kNoRole || count == 0) return;
    if (role == kRoleOpacity)
        decode_values(column, count, &raw.opacities[begin], 1);
    else if (role == kRoleLabel)
        decode_values(column, count, &raw.labels[begin], 1);
    else if (role == kRoleRadius)
        decode_values(column, count, &raw.radii[begin], 1);
    else if (role >= kRoleNx)
        decode_values(column, count, &raw.normals[begin][role - kRoleNx], 3);
    else if (role >= kRoleR)
        decode_values(column, count, &raw.colors[begin][role - kRoleR], 3);
    else
        decode_values(column, count, &raw.positions[begin][role], 3);
}

void settle_splats(const ReadJob& job, RawCloud& raw) {
    // The constant of the degree-0 spherical harmonic, 1 / (2 sqrt(pi)).
    constexpr float kHarmonic = 0.28209479177387814F;
    // Splats that let nine tenths of the light through are haze around the surface, not surface.
    constexpr double kLeastOpacity = 0.1;
    for (Vec3& color : raw.colors)
        for (int k = 0; k < 3; k++)
            color[k] = color[k] == color[k] ? std::clamp(0.5F + kHarmonic * color[k], 0.0F, 1.0F) : 0.0F;
    raw.color_white = 1.0F;
    const double least = portable::log(kLeastOpacity / (1.0 - kLeastOpacity));  // the inverse of the sigmoid
    std::vector<uint8_t> keep(raw.size());
    for (size_t i = 0; i < keep.size(); i++)
        keep[i] = raw.opacities[i] >= least;
    const size_t count = raw.size();
    const size_t out = raw.keep_only(keep);
    if (out == count) job.fail("is a Gaussian splat file, but all of its splats are nearly transparent.");
    if (out > 0)
        job.report.warnings.push_back(std::to_string(out) + " of " + std::to_string(count) +
                                      " splats have an opacity below 10 % and were left out.");
    raw.opacities.clear();
}

namespace {

// What 10^0 to 10^22 are as doubles, exactly.
constexpr double kPowers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                              1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

// "-12.345" where its digits make a whole number below 2^53: its quotient by a power of ten is the nearest
// double (W. Clinger, "How to Read Floating Point Numbers Accurately", 1990). Anything else: false.
bool parse_short_number(const char*& p, const char* end, double& value) {
    const char* q = p;
    const bool negative = q != end && *q == '-';
    if (negative) q++;
    uint64_t digits = 0;
    int count = 0;
    int places = 0;
    for (; q != end && static_cast<unsigned char>(*q - '0') < 10; q++, count++)
        digits = digits * 10 + static_cast<uint64_t>(*q - '0');
    if (q != end && *q == '.') {
        q++;
        for (; q != end && static_cast<unsigned char>(*q - '0') < 10; q++, places++)
            digits = digits * 10 + static_cast<uint64_t>(*q - '0');
    }
    count += places;
    // 19 digits never overflow 64 bits.
    if (count == 0 || count > 19 || places > 22 || digits > (uint64_t{1} << 53)) return false;
    if (q != end && (*q == 'e' || *q == 'E')) return false;
    const double magnitude = static_cast<double>(digits) / kPowers[places];
    value = negative ? -magnitude : magnitude;
    p = q;
    return true;
}

}  // namespace

bool parse_number(const char*& p, const char* end, double& value) {
    const char* begin = p;
    if (begin != end && *begin == '+' && begin + 1 != end && begin[1] != '-') begin++;
    if (parse_short_number(begin, end, value)) {
        p = begin;
        return true;
    }
    const std::from_chars_result result = std::from_chars(begin, end, value);
    if (result.ec == std::errc::invalid_argument) return false;
    if (result.ec == std::errc::result_out_of_range) {
        // Too small for a double is 0; too large is no number that we could use.
        const std::string_view text(begin, static_cast<size_t>(result.ptr - begin));
        const size_t exponent = text.find_first_of("eE");
        const bool small = exponent != std::string_view::npos && text.substr(exponent + 1).starts_with('-');
        value = small ? 0.0 : std::numeric_limits<double>::quiet_NaN();
    }
    p = result.ptr;
    return true;
}

}  // namespace treerec
