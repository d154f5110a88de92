// What a recipe's lines are.
#include <cmath>
#include <utility>

#include "edit/commands/command_text.h"
#include "growth/recipe.h"

namespace treerec {

namespace {

constexpr double kLeastEdge = 0.002, kLargestEdge = 1.0;  // metres
constexpr double kFarthest = 1000.0;                      // metres
constexpr double kLargest = 10.0;                         // metres, of lumps and mouths
constexpr size_t kFewestRadii = 3, kMostRadii = 64;       // of a section
constexpr double kLeastRadius = 0.2, kLargestRadius = 5.0;

void take_edges(GrowthRecipe& recipe, const EditArguments& arguments) {
    recipe.longest = arguments.number("longest");
    recipe.shortest = arguments.has("shortest") ? arguments.number("shortest") : recipe.longest * 15.0 / 35.0;
    if (recipe.shortest > 0.5 * recipe.longest)
        throw Error("The shortest edge must be at most half of the longest: with longest=" +
                    number_text(recipe.longest) + " give shortest=" + number_text(0.5 * recipe.longest) +
                    " or less.");
}

void take_steps(GrowthRecipe& recipe, const EditArguments& arguments) {
    recipe.steps = static_cast<int>(arguments.whole("count"));
}

void take_grain(GrowthRecipe& recipe, const EditArguments& arguments) {
    recipe.twist = arguments.number("twist");
}

GrowthPlace place_of(const EditArguments& arguments) {
    return {arguments.node("node"), arguments.number("along"), arguments.number("around")};
}

// inner: where it is not given, half of the radius.
double inner_of(const EditArguments& arguments, const char* name, const char* radius_name) {
    const double radius = arguments.number(radius_name);
    const double inner = arguments.has(name) ? arguments.number(name) : 0.5 * radius;
    if (inner > radius)
        throw Error(std::string(name) + "=" + number_text(inner) + " is larger than " + radius_name + "=" +
                    number_text(radius) + ": make it smaller.");
    return inner;
}

GrowthLip lip_of(const EditArguments& arguments) {
    return {arguments.number("swell"), inner_of(arguments, "inner", "swell"), arguments.number("growth"),
            arguments.number("wrap"), arguments.number("band")};
}

void take_burl(GrowthRecipe& recipe, const EditArguments& arguments) {
    GrowthFeature feature;
    feature.kind = GrowthFeature::Kind::kBurl;
    static_cast<GrowthPlace&>(feature) = place_of(arguments);
    feature.radius = arguments.number("radius");
    feature.inner = inner_of(arguments, "inner", "radius");
    feature.growth = arguments.number("growth");
    feature.from = arguments.number("from");
    if (arguments.on("grain")) {
        feature.length = arguments.number("length");
        feature.every = arguments.has("every") ? arguments.number("every") : 0.5 * feature.radius;
    }
    recipe.features.push_back(feature);
}

void take_hollow(GrowthRecipe& recipe, const EditArguments& arguments) {
    GrowthFeature feature;
    feature.kind = GrowthFeature::Kind::kHollow;
    static_cast<GrowthPlace&>(feature) = place_of(arguments);
    feature.width = arguments.number("width");
    feature.height = arguments.number("height");
    feature.depth = arguments.number("depth");
    feature.wall = arguments.number("wall");
    feature.from = arguments.number("from");
    feature.until = arguments.number("until");
    if (arguments.has("region")) feature.region = arguments.text("region");
    feature.lip = lip_of(arguments);
    if (feature.until <= feature.from)
        throw Error("A hollow that begins at from=" + number_text(feature.from) +
                    " must end later: give until= more than that.");
    recipe.features.push_back(feature);
}

void take_cuts(GrowthRecipe& recipe, const EditArguments& arguments) {
    recipe.cuts = GrowthCuts{arguments.number("least"), arguments.number("from"), arguments.number("depth"),
                             lip_of(arguments)};
}

void take_obstacle(GrowthRecipe& recipe, const EditArguments& arguments) {
    using Shape = GrowthObstacle::Shape;
    GrowthObstacle obstacle;
    const std::string& shape = arguments.text("shape");
    obstacle.shape = shape == "post"    ? Shape::kPost
                     : shape == "box"   ? Shape::kBox
                     : shape == "sheet" ? Shape::kSheet
                     : shape == "wire"  ? Shape::kWire
                     : shape == "ring"  ? Shape::kTorus
                                        : Shape::kMesh;
    static_cast<GrowthPlace&>(obstacle) = place_of(arguments);
    obstacle.gap = arguments.number("gap");
    if (arguments.has("middle")) obstacle.at = arguments.vector("middle");
    if (arguments.has("direction")) obstacle.direction = arguments.vector("direction");
    obstacle.length = arguments.number("length");
    obstacle.radius = arguments.number("radius");
    obstacle.width = arguments.number("width");
    obstacle.thickness = arguments.number("thickness");
    if (arguments.has("file")) obstacle.file = arguments.text("file");
    if (arguments.has("mesh")) obstacle.mesh = arguments.text("mesh");
    for (const auto& [name, axis] :
         {std::pair{"x", &obstacle.x}, std::pair{"y", &obstacle.y}, std::pair{"z", &obstacle.z}})
        if (arguments.has(name)) *axis = arguments.vector(name);
    const bool named = !obstacle.file.empty() || !obstacle.mesh.empty();
    if ((obstacle.shape == Shape::kMesh) != named)
        throw Error(named ? "An obstacle with file= needs shape=mesh."
                          : "An obstacle with shape=mesh needs file=, a .glb, .gltf or .obj file.");
    if (!obstacle.file.empty() && !obstacle.mesh.empty())
        throw Error("An obstacle is of a file= or of a mesh=, not of both.");
    obstacle.lip = lip_of(arguments);
    recipe.obstacles.push_back(obstacle);
}

void take_section(GrowthRecipe& recipe, const EditArguments& arguments) {
    GrowthSection section;
    static_cast<GrowthPlace&>(section) = place_of(arguments);
    for (const std::string_view word : split(arguments.text("radii"), ',')) {
        const std::optional<double> radius = read_number(word);
        if (!radius || !(*radius >= kLeastRadius && *radius <= kLargestRadius))
            throw Error("radii has " + quote_word(word) + ", where shares of the branch's radius from " +
                        number_text(kLeastRadius) + " to " + number_text(kLargestRadius) +
                        " belong, with commas between them: radii=1.2,0.9,1.1.");
        section.radii.push_back(*radius);
    }
    if (section.radii.size() < kFewestRadii || section.radii.size() > kMostRadii)
        throw Error("A section has " + std::to_string(section.radii.size()) + " radii, where it needs from " +
                    std::to_string(kFewestRadii) + " to " + std::to_string(kMostRadii) +
                    ": one in each of so many equal directions.");
    recipe.sections.push_back(std::move(section));
}

void take_seed(GrowthRecipe& recipe, const EditArguments& arguments) {
    recipe.seed = arguments.text("file");
}

void take_fuse(GrowthRecipe& recipe, const EditArguments&) {
    recipe.fuse = true;
}

std::vector<Parameter> with_place(double along, std::vector<Parameter> rest) {
    Parameter node = node_parameter("node", "on whose branch it is");
    node.standard = "root";
    node.required = false;
    std::vector<Parameter> all{
        node,
        length_parameter("along", along, -kFarthest, kFarthest,
                         "from the node along its branch; of the trunk from its base"),
        number_parameter("around", 0.0, -3600.0, 3600.0, "degrees about the branch").slider(0.0, 360.0)};
    all.insert(all.end(), rest.begin(), rest.end());
    return all;
}

void add_lip(std::vector<Parameter>& parameters, double swell, double growth, double wrap, double band) {
    parameters.push_back(
        length_parameter("swell", swell, 0.0, kLargest, "beside it in which bark grows faster")
            .slider(0.0, 0.5));
    parameters.push_back(
        length_parameter("inner", NAN, 0.0, kLargest, "beside it in which all grows alike; half of swell")
            .optional());
    parameters.push_back(
        number_parameter("growth", growth, 0.0, 20.0, "how much faster, over the usual").slider(0.0, 3.0));
    parameters.push_back(
        number_parameter("wrap", wrap, 0.0, 20.0, "how much bark beside it turns over it").slider(0.0, 2.0));
    parameters.push_back(
        length_parameter("band", band, 0.0, kLargest, "beside it in which bark turns").slider(0.0, 0.3));
}

std::vector<Parameter> hollow_parameters() {
    std::vector<Parameter> parameters = with_place(
        1.0,
        {length_parameter("width", 0.15, 0.001, kLargest, "of its mouth, across the branch"),
         length_parameter("height", 0.3, 0.001, kLargest, "of its mouth, along the branch"),
         length_parameter("depth", 0.15, 0.0, kLargest,
                          "of its ground below the bark; 0: a wound that heals over"),
         length_parameter("wall", 0.03, 0.0, kLargest, "of sound wood that is left on other sides"),
         number_parameter("from", 0.4, 0.0, 1.0, "share of the age of the wood there after which it begins"),
         number_parameter("until", 0.85, 0.0, 1.0, "share of that age after which no more bark decays"),
         text_parameter("region", {"hole.obj"},
                        "a closed mesh (.glb, .gltf, .obj) in which bark decays instead of width and height")
             .optional()});
    add_lip(parameters, 0.1, 0.3, 0.4, 0.06);
    return parameters;
}

std::vector<Parameter> cuts_parameters() {
    std::vector<Parameter> parameters{
        length_parameter("least", 0.02, 0.001, kLargest,
                         "of the wood's radius at its end; thinner ends are tips"),
        number_parameter("from", 0.6, 0.0, 1.0, "share of the age of the wood there after which it was cut"),
        length_parameter("depth", 0.0, 0.0, kLargest, "that the cut wood sinks in")};
    add_lip(parameters, 0.08, 0.4, 0.5, 0.05);
    return parameters;
}

std::vector<Parameter> obstacle_parameters() {
    std::vector<Parameter> parameters = with_place(
        1.0,
        {word_parameter("shape", {"post", "box", "sheet", "wire", "ring", "mesh"}, "what it is"),
         length_parameter("gap", 0.0, -kFarthest, kFarthest,
                          "from the bark of the end to its middle; under 0: inside"),
         point_parameter("middle", "where its middle is instead; moves a mesh").optional(),
         direction_parameter("direction", "along a post or wire, across a sheet or box, or of a ring's axis")
             .optional(),
         length_parameter("length", 2.0, 0.001, kFarthest, "of a post, wire, box or sheet"),
         length_parameter("radius", 0.05, 0.0005, kFarthest, "of a post or ring"),
         length_parameter("width", 0.1, 0.001, kFarthest, "of a box or sheet"),
         length_parameter("thickness", 0.004, 0.0005, kFarthest, "of a box, wire or ring"),
         text_parameter("file", {"fence.obj"}, "a mesh (.glb, .gltf, .obj) in the tree's space, metres")
             .optional(),
         text_parameter("mesh", {"fence"}, "instead, a mesh that is kept with a tree in a scene").optional(),
         offset_parameter("x", "where the X axis of a mesh points, as long as a metre of it is").optional(),
         offset_parameter("y", "likewise, of its Y axis").optional(),
         offset_parameter("z", "likewise, of its Z axis").optional(),
         text_parameter("scene", {"../Fence"}, "the node of the scene that it is, for the editor")
             .optional()});
    add_lip(parameters, 0.06, 0.4, 0.8, 0.03);
    return parameters;
}

}  // namespace

const std::vector<GrowthCommand>& growth_commands() {
    static const std::vector<GrowthCommand> commands{
        {"edges",
         "How fine the surface is.",
         {length_parameter("longest", 0.035, kLeastEdge, kLargestEdge, "edges are split above it"),
          length_parameter("shortest", NAN, kLeastEdge / 4.0, kLargestEdge,
                           "edges that become shorter are merged; at most half of longest")
              .optional()},
         take_edges},
        {"steps",
         "How many steps it grows.",
         {whole_parameter("count", 0, 0, 5000, "0: as many as the tree needs")},
         take_steps},
        {"grain",
         "How the grain winds about trunk and branches.",
         {number_parameter("twist", 2.0, -20.0, 20.0, "radians a metre").slider(-6.0, 6.0)},
         take_grain},
        {"burl", "A lump where cambium grows faster.",
         with_place(
             1.3,
             {length_parameter("radius", 0.3, 0.001, kLargest,
                               "around its middle in which cambium grows faster")
                  .slider(0.02, 1.0),
              length_parameter("inner", NAN, 0.0, kLargest,
                               "around its middle in which all grows alike; half of radius")
                  .optional(),
              number_parameter("growth", 0.5, 0.0, 20.0, "how much faster, over the usual").slider(0.0, 2.0),
              number_parameter("from", 0.0, 0.0, 1.0,
                               "share of the age of the wood there after which it begins"),
              switch_parameter("grain", false, "a ridge along the grain instead of a lump"),
              length_parameter("length", 1.0, 0.001, kFarthest, "of such a ridge"),
              length_parameter("every", NAN, 0.001, kLargest,
                               "from one lump of the ridge to the next; half of radius")
                  .optional()}),
         take_burl},
        {"hollow", "Bark that dies and wood that decays below it, with lips that grow over it.",
         hollow_parameters(), take_hollow},
        {"cuts", "Callus that grows over stubs and other ends where wood was cut.", cuts_parameters(),
         take_cuts},
        {"seed",
         "What it starts from: a closed mesh that the trunk begins in, instead of a small prism.",
         {text_parameter("file", {"stump.obj"}, "a mesh (.glb, .gltf, .obj) in the tree's space, metres")},
         take_seed},
        {"fuse", "Surfaces that meet become one, instead of only looking as one.", {}, take_fuse},
        {"section", "The outline of wood that is not round; sections of a branch go over into one another.",
         with_place(
             0.0, {text_parameter("radii", {"1.2,0.8,1.2,0.8"},
                                  "shares of the branch's radius in equal directions, the first at around")}),
         take_section},
        {"obstacle", "Something that does not yield; bark stops at it, swells and grows over it.",
         obstacle_parameters(), take_obstacle},
    };
    return commands;
}

}  // namespace treerec
