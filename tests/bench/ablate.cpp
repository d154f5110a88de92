// What each pass of the reconstruction is worth: it is left out, and the rest judged.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "accuracy.h"
#include "bench.h"
#include "child.h"
#include "error.h"
#include "fidelity/fidelity.h"
#include "file_bytes.h"
#include "pipeline/reconstruct.h"
#include "scan/cleaning/thin_cloud.h"
#include "skeleton/passes.h"

namespace treerec::bench {

namespace {

constexpr uint64_t kOtherSeeds = 12;    // from the guard's seeds to the next ones
constexpr size_t kMostScanned = 40000;  // points: larger scans are thinned
constexpr size_t kJudged = 20000;       // points that the surface is judged by
constexpr double kNearSurface = 0.01;   // metres from the bark: explained
constexpr double kSame = 0.0005;        // a difference below is none
constexpr double kPercent = 100.0;

// A pass or step, and how it is left out.
struct Variant {
    std::string name;
    std::function<void(ReconstructOptions&)> leave_out;
    bool cleans = false;
};

std::vector<Variant> all_variants() {
    std::vector<Variant> variants;
    for (const auto& [pass, name] : kPassNames)
        variants.push_back({name, [without = PassSet(pass)](ReconstructOptions& options) {
                                options.skeleton.left_out = without;
                            }});
    const auto add_cleaning = [&](const char* name, bool CleanOptions::*step) {
        variants.push_back(
            {name, [step](ReconstructOptions& options) { options.clean.*step = false; }, true});
    };
    add_cleaning("cleaning: extreme colours", &CleanOptions::remove_extreme_colors);
    add_cleaning("cleaning: outliers", &CleanOptions::remove_outliers);
    add_cleaning("cleaning: ground, walls", &CleanOptions::remove_ground);
    add_cleaning("cleaning: fragments", &CleanOptions::remove_fragments);
    variants.push_back({"cleaning: other trees",
                        [](ReconstructOptions& options) { options.clean.pick.enabled = false; }, true});
    return variants;
}

std::vector<Variant> chosen_variants(const std::vector<std::string>& names) {
    std::vector<Variant> all = all_variants();
    for (const std::string& name : names)
        if (std::none_of(all.begin(), all.end(), [&](const Variant& v) { return v.name == name; }))
            throw Error("There is no pass '" + name + "'.");
    if (!names.empty())
        std::erase_if(all, [&](const Variant& v) {
            return std::find(names.begin(), names.end(), v.name) == names.end();
        });
    return all;
}

// Shares; what a scan has none of is 0 for all variants.
struct Figures {
    double f = 0.0;        // of a grown tree: of length,
    double radius = 0.0;   // error,
    double dbh = 0.0;      // error
    double surface = 0.0;  // of a real scan: its points near the bark, and the bark near them, as F
    double seconds = 0.0;  // of all threads

    double worth() const { return f - radius - dbh + surface; }
};

// A scan to judge variants by. What does not differ between them is done once.
class Subject {
  public:
    virtual ~Subject() = default;

    const std::string& name() const { return name_; }
    virtual bool grown() const = 0;

    Figures figures(const Variant* without) {
        ReconstructOptions options;
        if (without) without->leave_out(options);
        ReconstructCache own;
        const bool other_clean = without && without->cleans;
        if (other_clean) own.read = cache_.read;
        const std::clock_t start = std::clock();
        Figures figures = judge(options, other_clean ? own : cache_);
        figures.seconds = static_cast<double>(judging_ - start) / CLOCKS_PER_SEC;
        return figures;
    }

  protected:
    explicit Subject(std::string name) : name_(std::move(name)) {}
    virtual Figures judge(const ReconstructOptions& options, ReconstructCache& cache) = 0;

    std::clock_t judging_ = 0;  // when the tree was there

  private:
    std::string name_;
    ReconstructCache cache_;
};

class GrownSubject : public Subject {
  public:
    explicit GrownSubject(const AccuracyCase& setting) : Subject(setting_name(setting)), scan_(setting) {}
    bool grown() const override { return true; }

  private:
    static std::string setting_name(const AccuracyCase& setting) {
        const char* kind = setting.leaves > 0.0      ? "leafy"
                           : setting.occlusion > 0.0 ? "hidden"
                           : setting.noise > 0.01    ? "noisy"
                                                     : "bare";
        return habit_name(setting.habit) + " " + std::to_string(setting.seed) + " " + kind;
    }

    Figures judge(const ReconstructOptions& options, ReconstructCache& cache) override {
        const AccuracyRow row = scan_.measure(options, &cache);
        judging_ = std::clock();
        return {row.f, std::min(kLargestError, row.radius_error),
                std::min(kLargestError, std::abs(row.dbh_error))};
    }

    GrownScan scan_;
};

class RealSubject : public Subject {
  public:
    explicit RealSubject(const std::string& path) : Subject(stem_of(path)), path_(path) {
        PointCloud cloud = read_cloud(path);
        if (cloud.size() <= kMostScanned) return;
        thin_cloud(cloud, kMostScanned);
        path_ = folder_.file("scan.ply");
        write_cloud(path_, cloud);
    }
    bool grown() const override { return false; }

  private:
    // By the wood that the whole reconstruction, which is the first one here, took for it.
    Figures judge(const ReconstructOptions& options, ReconstructCache& cache) override {
        std::optional<Reconstruction> made;
        try {
            made = reconstruct_tree(path_, options, nullptr, &cache);
        } catch (const Error&) {
            if (wood_.empty()) throw;
        }
        judging_ = std::clock();
        if (!made) return {};
        if (wood_.empty()) {
            wood_ = wood_of(*made);
            thin_cloud(wood_, kJudged);
        }
        const FidelityPart all = measure_fidelity(made->tree, wood_, {kNearSurface}).all;
        const double both = all.explained + all.coverage;
        Figures figures;
        figures.surface = both > 0.0 ? 2.0 * all.explained * all.coverage / both : 0.0;
        return figures;
    }

    std::string path_;
    ScratchFolder folder_;
    PointCloud wood_;
};

// What the pass added on each scan.
struct Gains {
    std::vector<Figures> with, without;
    std::vector<uint8_t> grown;

    double gain(size_t i) const { return with[i].worth() - without[i].worth(); }

    double mean() const {
        double sum = 0.0;
        for (size_t i = 0; i < with.size(); i++)
            sum += gain(i);
        return sum / static_cast<double>(with.size());
    }

    // Of the mean.
    double standard_error() const {
        const double count = static_cast<double>(with.size()), middle = mean();
        double squares = 0.0;
        for (size_t i = 0; i < with.size(); i++)
            squares += (gain(i) - middle) * (gain(i) - middle);
        return std::sqrt(squares / (count * std::max(1.0, count - 1.0)));
    }

    // The mean without the scan that speaks most for the pass.
    double least_mean() const {
        const double count = static_cast<double>(with.size());
        double most = gain(0);
        for (size_t i = 1; i < with.size(); i++)
            most = std::max(most, gain(i));
        return count > 1.0 ? (count * mean() - most) / (count - 1.0) : 0.0;
    }

    // Over grown trees or real scans alone; 0 where there are none.
    double mean_of(double Figures::*figure, bool of_grown) const {
        double sum = 0.0, count = 0.0;
        for (size_t i = 0; i < with.size(); i++) {
            if ((grown[i] != 0) != of_grown) continue;
            sum += with[i].*figure - without[i].*figure;
            count += 1.0;
        }
        return count > 0.0 ? sum / count : 0.0;
    }

    double seconds(const std::vector<Figures>& of) const {
        double sum = 0.0;
        for (const Figures& figures : of)
            sum += figures.seconds;
        return sum;
    }

    size_t changed(bool better) const {
        size_t count = 0;
        for (size_t i = 0; i < with.size(); i++)
            count += better ? gain(i) > kSame : gain(i) < -kSame;
        return count;
    }
};

// More than chance, whichever scan is left out.
bool pays(const Gains& gains) {
    return gains.least_mean() > 0.0 && gains.mean() > gains.standard_error();
}

std::vector<std::unique_ptr<Subject>> all_subjects(const std::vector<std::string>& scans, int seeds) {
    std::vector<std::unique_ptr<Subject>> subjects;
    for (AccuracyCase one : guard_cases())
        for (int seed = 0; seed < seeds; seed++, one.seed += kOtherSeeds)
            subjects.push_back(std::make_unique<GrownSubject>(one));
    for (const std::string& scan : scans)
        subjects.push_back(std::make_unique<RealSubject>(scan));
    return subjects;
}

// The whole first, and then without each of the variants.
std::vector<Figures> figures_of(Subject& subject, const std::vector<Variant>& variants) {
    subject.figures(nullptr);  // fills the cache, so that all times are of the same stages
    std::vector<Figures> figures = {subject.figures(nullptr)};
    for (const Variant& variant : variants)
        figures.push_back(subject.figures(&variant));
    return figures;
}

void print_table(const std::vector<Variant>& variants, const std::vector<Gains>& gains) {
    std::printf(
        "\n| pass | F | radius %% | DBH %% | surface F | better / worse | mean | standard error | least | "
        "CPU s "
        "%% | pays |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (size_t v = 0; v < variants.size(); v++) {
        const Gains& g = gains[v];
        std::printf(
            "| %s | %+.2f | %+.2f | %+.2f | %+.2f | %zu / %zu | %+.3f | %.3f | %+.3f | %+.1f | %s |\n",
            variants[v].name.c_str(), kPercent * g.mean_of(&Figures::f, true),
            kPercent * g.mean_of(&Figures::radius, true), kPercent * g.mean_of(&Figures::dbh, true),
            kPercent * g.mean_of(&Figures::surface, false), g.changed(true), g.changed(false),
            kPercent * g.mean(), kPercent * g.standard_error(), kPercent * g.least_mean(),
            kPercent * (g.seconds(g.with) / g.seconds(g.without) - 1.0), pays(g) ? "yes" : "no");
    }
}

}  // namespace

void bench_ablation(const std::vector<std::string>& scans, const Settings& settings) {
    const std::vector<Variant> variants = chosen_variants(settings.args);
    std::vector<Gains> gains(variants.size());
    size_t judged = 0;
    for (const std::unique_ptr<Subject>& subject : all_subjects(scans, settings.seeds)) {
        std::vector<Figures> figures;
        try {
            figures = figures_of(*subject, variants);
        } catch (const Error& error) {
            std::printf("%s: %s\n", subject->name().c_str(), error.what());
            continue;
        }
        judged++;
        for (size_t v = 0; v < variants.size(); v++) {
            gains[v].with.push_back(figures[0]);
            gains[v].without.push_back(figures[v + 1]);
            gains[v].grown.push_back(subject->grown() ? 1 : 0);
        }
        if (settings.repetitions == 0) continue;
        std::printf("%s: %.2f", subject->name().c_str(), kPercent * figures[0].worth());
        for (size_t v = 0; v < variants.size(); v++)
            if (std::abs(figures[0].worth() - figures[v + 1].worth()) > kSame)
                std::printf("; %s %+.2f", variants[v].name.c_str(),
                            kPercent * (figures[0].worth() - figures[v + 1].worth()));
        std::printf("\n");
        std::fflush(stdout);
    }
    if (judged == 0) throw Error("There is no scan to judge by.");
    Gains whole = gains.front();
    std::printf(
        "\n%zu scans. In points of 100, what each pass adds in the mean: to F, radius and DBH error of grown "
        "trees (at most 30), and of real scans to the F of points within 1 cm of bark and bark with points; "
        "all "
        "together; the mean without the scan that speaks most for it.\n",
        judged);
    std::printf("Whole: %.1f CPU s\n", whole.seconds(whole.with));
    print_table(variants, gains);
}

}  // namespace treerec::bench
