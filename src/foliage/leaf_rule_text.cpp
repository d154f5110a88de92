#include "foliage/leaf_rule_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <utility>

#include "error.h"
#include "lsystem/lstring.h"

namespace treerec {

namespace {

constexpr double kSprigAngle = 45.0;  // degrees, of a turn without a number

struct Number {
    const char* name;
    double LeafRules::*member;
};
constexpr Number kNumbers[] = {
    {"divergence", &LeafRules::divergence},
    {"internode", &LeafRules::internode},
    {"crowding", &LeafRules::crowding},
    {"twig_length", &LeafRules::twig_length},
    {"clustering", &LeafRules::clustering},
    {"maximum_radius", &LeafRules::maximum_radius},
    {"leaf_area_index", &LeafRules::leaf_area_index},
    {"leaf_size", &LeafRules::leaf_size},
    {"size_variation", &LeafRules::size_variation},
    {"blade_width", &LeafRules::blade_width},
    {"petiole_length", &LeafRules::petiole},
    {"angle", &LeafRules::angle},
    {"closing", &LeafRules::closing},
    {"droop", &LeafRules::droop},
    {"angle_variation", &LeafRules::angle_variation},
    {"phototropism", &LeafRules::phototropism},
    {"curl", &LeafRules::curl},
    {"fold", &LeafRules::fold},
    {"follow_density", &LeafRules::follow_density},
    {"follow_color", &LeafRules::follow_color},
};

struct Whole {
    const char* name;
    int LeafRules::*member;
};
constexpr Whole kWholes[] = {
    {"whorl_size", &LeafRules::whorl},
    {"leaflets", &LeafRules::leaflets},
    {"maximum_leaves", &LeafRules::maximum_leaves},
};

// In the order of their enums.
constexpr const char* kArrangements[] = {"alternate", "opposite", "decussate",
                                         "whorled",   "spiral",   "fascicled"};
constexpr const char* kForms[] = {"spray", "simple", "pinnate", "palmate", "needles", "sprig"};

// A rule's words in the order in which it is written.
struct Words {
    std::string preset;
    std::vector<std::pair<std::string, std::string>> changes;
};

std::vector<std::string> known_names() {
    std::vector<std::string> names{"look", "arrangement", "form", "sprig", "sprig_dialect"};
    for (const Number& number : kNumbers)
        names.emplace_back(number.name);
    for (const Whole& whole : kWholes)
        names.emplace_back(whole.name);
    return names;
}

template <typename List>
std::string listed(const List& list) {
    std::string text;
    for (const auto& one : list)
        text += (text.empty() ? "" : ", ") + std::string(one);
    return text;
}

Words split_words(std::string_view text) {
    Words words;
    const std::vector<std::string> names = known_names();
    constexpr std::string_view kBlanks = " \t\r\n";
    for (size_t at = text.find_first_not_of(kBlanks); at != std::string_view::npos;) {
        const size_t end = std::min(text.find_first_of(kBlanks, at), text.size());
        const std::string_view word = text.substr(at, end - at);
        at = text.find_first_not_of(kBlanks, end);
        const size_t equals = word.find('=');
        if (equals == std::string_view::npos) {
            const std::vector<std::string> presets = leaf_preset_names();
            if (std::find(presets.begin(), presets.end(), word) == presets.end())
                throw Error(quote_word(word) + " is no leaf rule; write default, one of " + listed(presets) +
                            ", or changes of a rule, as in droop=60.");
            if (!words.preset.empty())
                throw Error("A leaf rule begins with one preset, not with '" + words.preset + "' and " +
                            quote_word(word) + ".");
            words.preset = word;
            continue;
        }
        const std::string_view name = word.substr(0, equals);
        if (std::find(names.begin(), names.end(), name) == names.end())
            throw Error("A leaf rule has no " + quote_word(name) + "; it has " + listed(names) + ".");
        for (const auto& [other, value] : words.changes)
            if (other == name) throw Error("The leaf rule gives " + quote_word(name) + " twice.");
        words.changes.emplace_back(name, word.substr(equals + 1));
    }
    const auto place = [&](const std::string& name) { return std::find(names.begin(), names.end(), name); };
    std::sort(words.changes.begin(), words.changes.end(),
              [&](const auto& a, const auto& b) { return place(a.first) < place(b.first); });
    return words;
}

double read_number(const std::string& name, std::string_view text) {
    double value = 0.0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (failure != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        throw Error("The leaf rule's " + name + " must be a number, not " + quote_word(text) + ".");
    return value;
}

int read_whole(const std::string& name, std::string_view text) {
    int value = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (failure != std::errc() || end != text.data() + text.size() || value < 0)
        throw Error("The leaf rule's " + name + " must be a whole number, not " + quote_word(text) + ".");
    return value;
}

template <typename Names>
int read_choice(const std::string& name, std::string_view text, const Names& names) {
    for (size_t i = 0; i < std::size(names); i++)
        if (text == names[i]) return static_cast<int>(i);
    throw Error("The leaf rule's " + name + " must be one of " + listed(names) + ", not " + quote_word(text) +
                ".");
}

std::string read_look(const std::string& text) {
    if (!leaf_preset(text).enabled)
        throw Error("There is no picture of '" + text + "' for the leaf rule's look.");
    return text;
}

std::string number_text(double value) {
    char buffer[32];
    return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

LeafKind kind_of(const Words& words, const LeafRules& own) {
    LeafKind kind;
    kind.rules = words.preset.empty() ? own : leaf_preset(words.preset);
    LeafRules& rules = kind.rules;
    rules.follow_density = std::min(rules.follow_density, own.follow_density);
    rules.follow_color = std::min(rules.follow_color, own.follow_color);
    if (!words.preset.empty() && rules.enabled) kind.look = words.preset;
    rules.internode *= leaves_per_node(rules);
    std::optional<LStringDialect> dialect;
    for (const auto& [name, text] : words.changes)
        if (name == "sprig_dialect") dialect = parse_lstring_dialect(text);
    if (dialect && std::none_of(words.changes.begin(), words.changes.end(),
                                [](const auto& one) { return one.first == "sprig"; }))
        throw Error("The leaf rule's sprig_dialect is of a sprig, and it has none.");
    for (const auto& [name, text] : words.changes) {
        if (name == "look") {
            kind.look = read_look(text);
            rules.spray_cover = leaf_preset(text).spray_cover;
        }
        if (name == "arrangement")
            rules.arrangement = static_cast<LeafArrangement>(read_choice(name, text, kArrangements));
        if (name == "form") rules.form = static_cast<LeafForm>(read_choice(name, text, kForms));
        if (name == "sprig") {
            rules.sprig = read_sprig(text, dialect);
            rules.form = LeafForm::kSprig;
        }
        for (const Number& number : kNumbers)
            if (name == number.name) rules.*number.member = read_number(name, text);
        for (const Whole& whole : kWholes)
            if (name == whole.name) rules.*whole.member = read_whole(name, text);
    }
    check_leaf_rules(rules);
    rules.internode /= leaves_per_node(rules);
    check_leaf_rules(rules);
    return kind;
}

std::string text_of(const Words& words) {
    std::string text = words.preset;
    for (const auto& [name, value] : words.changes) {
        const std::string& known = name;
        const auto is_number = [&](const auto& list) {
            return std::any_of(std::begin(list), std::end(list),
                               [&](const auto& one) { return known == one.name; });
        };
        text += (text.empty() ? "" : " ") + name + "=";
        text += is_number(kNumbers) || is_number(kWholes) ? number_text(read_number(name, value)) : value;
    }
    return text;
}

Words read_words(std::string_view text) {
    Words words = split_words(text);
    if (words.preset.empty() && words.changes.empty())
        throw Error("A leaf rule is missing: write default, a preset, or changes of a rule, as in droop=60.");
    return words;
}

bool is_default(std::string_view text) {
    return text == "default";
}

}  // namespace

std::string plain_leaf_rule(std::string_view text) {
    if (is_default(text)) return "";
    const Words words = read_words(text);
    kind_of(words, LeafRules());
    return text_of(words);
}

LeafKind make_leaf_kind(std::string_view text, const LeafRules& own) {
    if (is_default(text)) return {"", "", own};
    const Words words = read_words(text);
    LeafKind kind = kind_of(words, own);
    kind.text = text_of(words);
    return kind;
}

std::vector<LeafKind> leaf_kinds(const Tree& tree, const LeafRules& own) {
    std::vector<LeafKind> kinds{{"", "", own}};
    for (const std::string& rule : tree.leaf_rules())
        kinds.push_back(make_leaf_kind(rule, own));
    return kinds;
}

std::shared_ptr<const LeafSprig> read_sprig(std::string_view string, std::optional<LStringDialect> dialect) {
    LStringOptions options;
    options.dialect_is_told = dialect.has_value();
    options.dialect = dialect.value_or(options.dialect);
    options.leaf_symbols = "L";
    options.angle = kSprigAngle;
    LStringTree read = read_lstring_with_leaves(string, options);
    if (read.tree.size() < 2) throw Error("This string draws no twig: it has no F.");
    auto sprig = std::make_shared<LeafSprig>();
    sprig->wood = std::move(read.tree);
    for (const LStringLeaf& leaf : read.leaves)
        sprig->leaves.push_back({leaf.position, leaf.heading, leaf.up, leaf.size});
    return sprig;
}

}  // namespace treerec
