#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "error.h"
#include "lsystem/grammar.h"
#include "lsystem/short_number.h"

namespace treerec {

namespace {

constexpr uint32_t kNone = UINT32_MAX;

// A string of modules: symbols[i] has the parameters values[first[i]] up to values[first[i + 1]].
struct ModuleString {
    std::vector<char> symbols;
    std::vector<uint32_t> first{0};
    std::vector<double> values;

    size_t size() const { return symbols.size(); }
    int count(size_t i) const { return static_cast<int>(first[i + 1] - first[i]); }
    size_t bytes() const { return 5 * symbols.size() + 8 * values.size(); }
    void clear() {
        symbols.clear();
        first.assign(1, 0);
        values.clear();
    }
    void end_module(char symbol) {
        symbols.push_back(symbol);
        first.push_back(static_cast<uint32_t>(values.size()));
    }
};

class Rewriter {
  public:
    Rewriter(const Grammar& grammar, const RewriteOptions& options, Progress* progress)
        : grammar_(grammar),
          options_(options),
          progress_(progress),
          random_(options.seed),
          start_(std::chrono::steady_clock::now()) {
        size_t variables = 1;
        for (size_t i = 0; i < grammar.rules.size(); i++) {
            const GrammarRule& rule = grammar.rules[i];
            rules_of_[static_cast<unsigned char>(rule.strict.symbol)].push_back(&rule);
            has_context_ = has_context_ || !rule.left.empty() || !rule.right.empty();
            variables = std::max(variables, static_cast<size_t>(rule.variables));
        }
        variables_.resize(variables);
    }

    std::string rewrite() {
        steps_ = options_.iterations >= 0 ? options_.iterations : grammar_.iterations;
        for (const GrammarModule& module : grammar_.axiom)
            append(module, "the axiom");
        std::swap(now_, next_);
        for (step_ = 1; step_ <= steps_; step_++) {
            if (progress_) progress_->update(static_cast<double>(step_ - 1) / steps_, "Growing");
            next_.clear();
            find_brackets();
            if (has_context_) find_neighbours();
            for (size_t i = 0; i < now_.size();)
                i = rewrite_module(i);
            std::swap(now_, next_);
        }
        return text();
    }

  private:
    // Once for every unit of work.
    void tick() {
        if ((++ticks_ & 0x3ff) != 0) return;
        if (progress_) progress_->check();
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start_;
        if (taken.count() > options_.most_seconds)
            stop("takes longer than " + whole(options_.most_seconds) + " seconds");
    }

    static std::string whole(double number) { return std::to_string(std::llround(number)); }

    [[noreturn]] void stop(const std::string& what) const {
        throw Error("The grammar " + what + " (in step " + std::to_string(step_) + " of " +
                    std::to_string(steps_) + "); lower its iterations.");
    }

    void require_room() const {
        if (next_.size() > options_.most_symbols)
            stop("grows past " + std::to_string(options_.most_symbols) + " symbols");
        if (now_.bytes() + next_.bytes() > options_.most_bytes)
            stop("needs more than " + std::to_string(options_.most_bytes >> 20) + " MB");
    }

    void append(const GrammarModule& module, const std::string& where) {
        tick();
        for (const Expression& expression : module.parameters) {
            const double value = expression.evaluate(variables_.data(), random_);
            if (!std::isfinite(value))
                throw Error("The grammar, " + where + ": a parameter of " + quote_word({&module.symbol, 1}) +
                            " is no finite number in step " + std::to_string(step_) + ".");
            next_.values.push_back(value);
        }
        next_.end_module(module.symbol);
        require_room();
    }

    // mate_[i]: the bracket that belongs to the bracket i. Strings are balanced, since axiom and successors
    // are.
    void find_brackets() {
        mate_.assign(now_.size(), kNone);
        std::vector<uint32_t> open;
        for (size_t i = 0; i < now_.size(); i++) {
            if (now_.symbols[i] == '[') open.push_back(static_cast<uint32_t>(i));
            if (now_.symbols[i] != ']') continue;
            mate_[i] = open.back();
            mate_[open.back()] = static_cast<uint32_t>(i);
            open.pop_back();
        }
    }

    bool is_ignored(size_t i) const { return grammar_.ignored[static_cast<unsigned char>(now_.symbols[i])]; }

    // left_[i]: what stands to the left of i on the way to the root. right_[i]: the first from i on that is
    // not ignored, brackets included.
    void find_neighbours() {
        const size_t count = now_.size();
        left_.assign(count, kNone);
        right_.assign(count + 1, static_cast<uint32_t>(count));
        std::vector<uint32_t> saved;
        uint32_t last = kNone;
        for (size_t i = 0; i < count; i++) {
            left_[i] = last;
            if (now_.symbols[i] == '[') {
                saved.push_back(last);
            } else if (now_.symbols[i] == ']') {
                last = saved.back();
                saved.pop_back();
            } else if (!is_ignored(i)) {
                last = static_cast<uint32_t>(i);
            }
        }
        for (size_t i = count; i-- > 0;)
            right_[i] = is_ignored(i) ? right_[i + 1] : static_cast<uint32_t>(i);
    }

    bool bind(const GrammarPattern& pattern, size_t i) {
        if (now_.symbols[i] != pattern.symbol || now_.count(i) != pattern.count) return false;
        for (int k = 0; k < pattern.count; k++)
            variables_[static_cast<size_t>(pattern.first + k)] =
                now_.values[now_.first[i] + static_cast<uint32_t>(k)];
        return true;
    }

    bool matches_left(const GrammarRule& rule, size_t i) {
        for (size_t k = rule.left.size(); k-- > 0;) {
            i = left_[i];
            if (i == kNone || !bind(rule.left[k], i)) return false;
        }
        return true;
    }

    // rule.right from its k-th symbol on against the string from i on. Branches that the context does not
    // name are skipped; the first of several that fits is taken.
    bool matches_right(const GrammarRule& rule, size_t k, size_t i, std::vector<uint32_t>& groups) {
        if (k == rule.right.size()) return true;
        tick();
        i = right_[i];
        const GrammarPattern& pattern = rule.right[k];
        if (pattern.symbol == ']') {
            const uint32_t group = groups.back();
            groups.pop_back();
            const bool fits = matches_right(rule, k + 1, mate_[group] + 1, groups);
            groups.push_back(group);
            return fits;
        }
        for (; i < now_.size() && now_.symbols[i] == '['; i = right_[mate_[i] + 1]) {
            tick();
            if (pattern.symbol != '[') continue;
            groups.push_back(static_cast<uint32_t>(i));
            const bool fits = matches_right(rule, k + 1, i + 1, groups);
            groups.pop_back();
            if (fits) return true;
        }
        return i < now_.size() && bind(pattern, i) && matches_right(rule, k + 1, i + 1, groups);
    }

    bool applies(const GrammarRule& rule, size_t i) {
        if (!bind(rule.strict, i) || !matches_left(rule, i)) return false;
        groups_.clear();
        if (!rule.right.empty() && !matches_right(rule, 0, i + 1, groups_)) return false;
        return rule.condition.empty() || rule.condition.evaluate(variables_.data(), random_) != 0.0;
    }

    double weight_of(const GrammarRule& rule) {
        const double weight = rule.weight.evaluate(variables_.data(), random_);
        if (!(weight >= 0.0) || !std::isfinite(weight))
            throw Error("The grammar, the rule in line " + std::to_string(rule.line) +
                        ": its weight is negative or no finite number.");
        return weight;
    }

    // The first rule that applies; where that one has a weight, one of all those with a weight of the same
    // rank (with or without a context) that apply.
    const GrammarRule* choose(size_t i) {
        const std::vector<const GrammarRule*>& rules = rules_of_[static_cast<unsigned char>(now_.symbols[i])];
        candidates_.clear();
        weights_.clear();
        double sum = 0.0;
        for (const GrammarRule* rule : rules) {
            const bool contextual = !rule->left.empty() || !rule->right.empty();
            if (!candidates_.empty()) {
                const GrammarRule* best = candidates_[0];
                if (contextual != (!best->left.empty() || !best->right.empty())) break;
                if (rule->weight.empty()) continue;
            }
            tick();
            if (!applies(*rule, i)) continue;
            if (rule->weight.empty()) return rule;
            candidates_.push_back(rule);
            sum += weight_of(*rule);
            weights_.push_back(sum);
        }
        if (candidates_.empty() || !(sum > 0.0)) return nullptr;
        const double drawn = random_.uniform() * sum;
        size_t k = 0;
        while (k + 1 < candidates_.size() && weights_[k] <= drawn)
            k++;
        applies(*candidates_[k], i);  // its variables again
        return candidates_[k];
    }

    // Returns the next module to rewrite.
    size_t rewrite_module(size_t i) {
        tick();
        if (const GrammarRule* rule = choose(i)) {
            for (const GrammarModule& module : rule->successor)
                append(module, "the rule in line " + std::to_string(rule->line));
            return i + 1;
        }
        if (now_.symbols[i] == '%') {
            // Its branch ends here; so does the %.
            for (i++; i < now_.size() && now_.symbols[i] != ']'; i++)
                if (now_.symbols[i] == '[') i = mate_[i];
            return i;
        }
        next_.values.insert(next_.values.end(), now_.values.begin() + now_.first[i],
                            now_.values.begin() + now_.first[i + 1]);
        next_.end_module(now_.symbols[i]);
        require_room();
        return i + 1;
    }

    std::string text() {
        std::string out;
        for (size_t i = 0; i < now_.size(); i++) {
            tick();
            out += now_.symbols[i];
            for (uint32_t k = now_.first[i]; k < now_.first[i + 1]; k++) {
                out += k == now_.first[i] ? '(' : ',';
                append_exact(out, now_.values[k]);
            }
            if (now_.count(i) > 0) out += ')';
            if (out.size() > options_.most_bytes)
                stop("needs more than " + std::to_string(options_.most_bytes >> 20) + " MB");
        }
        return out;
    }

    const Grammar& grammar_;
    const RewriteOptions& options_;
    Progress* progress_;
    Random random_;
    std::chrono::steady_clock::time_point start_;
    std::array<std::vector<const GrammarRule*>, 256> rules_of_;
    bool has_context_ = false;
    int step_ = 0;
    int steps_ = 0;
    uint64_t ticks_ = 0;
    ModuleString now_;
    ModuleString next_;
    std::vector<uint32_t> mate_;
    std::vector<uint32_t> left_;
    std::vector<uint32_t> right_;
    std::vector<uint32_t> groups_;
    std::vector<double> variables_;
    std::vector<const GrammarRule*> candidates_;
    std::vector<double> weights_;
};

}  // namespace

std::string rewrite(const Grammar& grammar, const RewriteOptions& options, Progress* progress) {
    return Rewriter(grammar, options, progress).rewrite();
}

}  // namespace treerec
