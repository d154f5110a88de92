#include "scan/readers.h"

#include <charconv>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <utility>

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
    {"normalx", kRoleNx},    {"normaly", kRoleNy}, {"normalz", kRoleNz},
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
    for (const int first : {kRoleR, kRoleNx}) {
        if (taken[first] && taken[first + 1] && taken[first + 2]) continue;
        for (int8_t& role : roles)
            if (role >= first && role < first + 3) role = kNoRole;
    }
    return roles;
}

bool has_role(const std::vector<int8_t>& roles, Role role) {
    for (const int8_t r : roles)
        if (r == role) return true;
    return false;
}

std::string describe_roles(const std::vector<int8_t>& roles) {
    static constexpr const char* kNames[] = {"x", "y", "z", "r", "g", "b", "nx", "ny", "nz"};
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

bool parse_number(const char*& p, const char* end, double& value) {
    const char* begin = p;
    if (begin != end && *begin == '+' && begin + 1 != end && begin[1] != '-') begin++;
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
