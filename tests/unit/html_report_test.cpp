// report.html: one file, nothing from elsewhere, well-formed, and its pictures.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "cli_runner.h"
#include "error.h"
#include "fidelity/picture.h"

namespace treerec {
namespace {

using test::Cli;
using test::Outcome;

// Every element that is opened is closed, in order, but for those that have no end.
std::string first_mismatch(const std::string& html) {
    std::vector<std::string> open;
    for (size_t at = html.find('<', 1); at != std::string::npos; at = html.find('<', at + 1)) {
        const std::string tag = html.substr(at, html.find('>', at) + 1 - at);
        const size_t name_at = tag[1] == '/' ? 2 : 1;
        const std::string name = tag.substr(name_at, tag.find_first_of(" >", name_at) - name_at);
        if (name == "meta" || name == "img" || tag[tag.size() - 2] == '/') continue;
        if (name_at == 1) {
            open.push_back(name);
        } else if (open.empty() || open.back() != name) {
            return tag;
        } else {
            open.pop_back();
        }
    }
    return open.empty() ? "" : open.back();
}

TEST_F(Cli, ThePageStandsOnItsOwn) {
    ASSERT_EQ(run("synth -o grown --seed 3 --quiet").code, 0);
    const Outcome made = run("reconstruct grown/scan.ply -o out/report.html --html 'out/a <b> & c.html'");
    ASSERT_EQ(made.code, 0) << made.error;
    EXPECT_NE(made.out.find("wrote out/report.html"), std::string::npos) << made.out;
    std::string html = get("out/report.html");
    EXPECT_EQ(html, get("out/a <b> & c.html"));
    EXPECT_EQ(html.rfind("<!DOCTYPE html>", 0), 0u);
    // Pictures: the tree from two sides, the heat map from four.
    // (Not by a regular expression: std::regex recurses once per character.)
    const std::string picture = "src=\"data:image/png;base64,iVBOR";
    int pictures = 0;
    for (size_t at = html.find(picture); at != std::string::npos; at = html.find(picture)) {
        html.erase(at, html.find('"', at + picture.size()) + 1 - at);
        pictures++;
    }
    EXPECT_EQ(pictures, 6);
    EXPECT_EQ(first_mismatch(html), "");
    for (const char* elsewhere : {"grown/", "http", "src=", "href=", "<script", "@import", "nan", "inf "})
        EXPECT_EQ(html.find(elsewhere), std::string::npos) << elsewhere;
    for (const char* wanted : {"Trunk", "Order 1", "Lighter versions", "Worth a look", "<svg", "scan.ply"})
        EXPECT_NE(html.find(wanted), std::string::npos) << wanted;
}

TEST_F(Cli, ThePageTellsNamesAsTheyAre) {
    ASSERT_EQ(run("synth -o grown --seed 3 --quiet").code, 0);
    test::fs::rename(path("grown/scan.ply"), path("grown/<i>oak & \xff.ply"));
    const Outcome made = run("reconstruct \"grown/<i>oak & \xff.ply\" --html out/r.html --quiet");
    ASSERT_EQ(made.code, 0) << made.error;
    const std::string html = get("out/r.html");
    EXPECT_NE(html.find("<h1>&lt;i&gt;oak &amp; \xef\xbf\xbd</h1>"), std::string::npos);
    EXPECT_EQ(html.find("<i>oak"), std::string::npos);
    EXPECT_EQ(html.find('\xff'), std::string::npos);
}

TEST_F(Cli, APageThatCannotBeWrittenIsRefusedFirst) {
    ASSERT_EQ(run("synth -o grown --seed 3 --quiet").code, 0);
    EXPECT_EQ(run("reconstruct grown/scan.ply --html nowhere/r.html").code, 2);
    EXPECT_EQ(run("reconstruct grown/scan.ply -o out/r.html --html out/r.html").code, 2);
    EXPECT_TRUE(out_is_empty());
}

TEST_F(Cli, ScoreTellsTheFidelity) {
    ASSERT_EQ(run("synth -o grown --seed 3 --quiet").code, 0);
    ASSERT_EQ(run("reconstruct grown/scan.ply -o grown/tree.ply --quiet").code, 0);
    const Outcome text = run("score grown/tree.ply grown/scan.ply --levels 3 --quiet");
    ASSERT_EQ(text.code, 0) << text.error;
    for (const char* wanted : {"R_s 0.", "trunk ", "order 1 ", "nodes ", "clusters", "doubtful"})
        EXPECT_NE(text.out.find(wanted), std::string::npos) << wanted << text.out;
    const Outcome json = run("score grown/tree.ply grown/scan.ply --json --tolerance 0.05");
    for (const char* wanted : {"\"R_s\"", "\"by_order\"", "\"unexplained\"", "\"tolerance_m\": 0.05"})
        EXPECT_NE(json.out.find(wanted), std::string::npos) << wanted;
    EXPECT_EQ(run("score grown/tree.ply grown/scan.ply --photos grown").code, 2);
    const Outcome none = run("score grown/tree.ply grown/scan.ply --photos grown --masks grown");
    EXPECT_EQ(none.code, 1);
    EXPECT_NE(none.error.find("cameras.bin"), std::string::npos) << none.error;
}

PictureView small_view() {
    PictureView view;
    view.width = view.height = 2.0;
    view.pixels = 64;
    return view;
}

bool is_white(const uint8_t* pixel) {
    return pixel[0] == 255 && pixel[1] == 255 && pixel[2] == 255;
}

TEST(Picture, DrawsWhatIsNearOverWhatIsFar) {
    Picture picture(small_view());
    const std::vector<Vec3> points = {{0.5F, 0.5F, 0.0F}, {0.5F, 0.5F, 1.0F}, {-0.5F, -0.5F, 0.0F}};
    picture.draw(points, {{255, 0, 0}, {0, 0, 255}, {0, 255, 0}}, 0.2);
    const Image image = picture.finish();
    ASSERT_EQ(image.width, 64);
    ASSERT_EQ(image.height, 64);
    // The viewer stands at +z; up is up and right is right.
    EXPECT_GT(image.at(48, 16)[2], 200);
    EXPECT_LT(image.at(48, 16)[0], 50);
    EXPECT_GT(image.at(16, 48)[1], 200);
    EXPECT_TRUE(is_white(image.at(16, 16)));
    // From behind it is the other way round.
    PictureView behind = small_view();
    behind.azimuth = kPi;
    Picture other(behind);
    other.draw(points, {{255, 0, 0}, {0, 0, 255}, {0, 255, 0}}, 0.2);
    const Image back = other.finish();
    EXPECT_GT(back.at(16, 16)[0], 200);
    EXPECT_LT(back.at(16, 16)[2], 50);
}

TEST(Picture, ATriangleCoversItsArea) {
    Mesh mesh;
    for (const Vec3& p : {Vec3(-0.5F, -0.5F, 0.0F), Vec3(0.5F, -0.5F, 0.0F), Vec3(-0.5F, 0.5F, 0.0F)})
        mesh.positions.push_back(p);
    for (uint32_t i : {0U, 1U, 2U})
        mesh.indices.push_back(i);
    Picture picture(small_view());
    picture.draw(mesh, {100, 80, 60});
    const Image image = picture.finish();
    int covered = 0;
    for (int i = 0; i < 64 * 64; i++)
        covered += !is_white(image.at(i % 64, i / 64));
    EXPECT_NEAR(covered, 0.5 * 32 * 32, 40);
    EXPECT_FALSE(is_white(image.at(18, 46)));
    EXPECT_TRUE(is_white(image.at(44, 20)));
}

TEST(Picture, BarkTakesTheHeatOfItsWood) {
    Tree tree;
    const NodeId root = tree.add_root(DVec3(0.0), 0.05);
    const NodeId middle = tree.add_child(root, DVec3(0.0, 1.0, 0.0), 0.05);
    tree.add_child(middle, DVec3(0.0, 2.0, 0.0), 0.05);
    tree.add_child(middle, DVec3(1.0, 1.0, 0.0), 0.05);
    // The lower half was seen on its bark, the upper half 5 cm off it, the side branch not at all.
    PointCloud cloud;
    for (int i = 1; i < 100; i++) {
        cloud.positions.emplace_back(0.05, 0.009 * i, 0.0);
        cloud.positions.emplace_back(-0.1, 1.05 + 0.009 * i, 0.0);
    }
    const Fidelity fidelity = measure_fidelity(tree, cloud);
    Mesh bark;
    for (const Vec3& p : {Vec3(0.0F, 0.5F, 0.05F), Vec3(0.0F, 1.5F, 0.05F), Vec3(0.5F, 1.05F, 0.0F)})
        bark.positions.push_back(p);
    const std::vector<Rgb> colors = bark_heat(tree, fidelity, bark);
    EXPECT_EQ(colors[0], heat_color(0.0, 0.02));
    EXPECT_EQ(colors[1], heat_color(0.05, 0.02));
    EXPECT_EQ(colors[2], kUnseenWood);
    EXPECT_THROW(bark_heat(Tree(), fidelity, bark), Error);
}

TEST(Picture, HeatGoesFromBlueToRed) {
    const Rgb cold = heat_color(0.0, 0.02), hot = heat_color(0.06, 0.02), pale = heat_color(0.02, 0.02);
    EXPECT_GT(cold[2], cold[0]);
    EXPECT_GT(hot[0], hot[2]);
    EXPECT_GT(pale[0] + pale[1] + pale[2], std::max(cold[0] + cold[1] + cold[2], hot[0] + hot[1] + hot[2]));
    EXPECT_EQ(heat_color(5.0, 0.02), hot);
    EXPECT_EQ(heat_color(0.0, 0.0), cold);
    EXPECT_EQ(heat_color(1.0, 0.0), hot);
    EXPECT_THROW(Picture(PictureView{0.0, DVec3(0.0), 1.0, 1.0, 8}), Error);
    EXPECT_THROW(Picture(PictureView{0.0, DVec3(0.0), 0.0, 1.0, 64}), Error);
}

}  // namespace
}  // namespace treerec
