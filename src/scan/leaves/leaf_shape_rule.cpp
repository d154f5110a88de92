#include "scan/leaves/leaf_shape_rule.h"

#include <array>

#include "scan/leaves/shape_terms.h"

namespace treerec {

namespace {

constexpr float kBias = -0.912F;
constexpr ShapeTerms kShapeTerms{{
    {{{0.4209F, 0.2340F, -0.425F},
      {0.2754F, 0.1797F, -0.203F},
      {0.3027F, 0.1816F, 0.528F},
      {0.3599F, 0.1624F, -0.468F},
      {2.248F, 0.4428F, -0.050F}}},
    {{{0.3997F, 0.2186F, -0.011F},
      {0.2666F, 0.1669F, 0.037F},
      {0.3336F, 0.1836F, -0.178F},
      {0.4283F, 0.1876F, 0.451F},
      {2.778F, 0.6209F, -0.313F}}},
    {{{0.3375F, 0.1858F, -0.060F},
      {0.2553F, 0.1533F, 0.167F},
      {0.4072F, 0.1842F, 0.001F},
      {0.5084F, 0.2021F, 0.211F},
      {3.366F, 0.7300F, -0.291F}}},
    {{{0.0F, 1.0F, 0.0F},
      {0.0F, 1.0F, 0.0F},
      {0.5064F, 0.1801F, 0.470F},
      {0.6387F, 0.2271F, -0.890F},
      {4.113F, 0.7961F, 1.988F}}},
}};
struct PathTerm {
    float CellPath::*member;
    Term term;
};
constexpr std::array<PathTerm, 10> kPathTerms{{
    {&CellPath::height, {1.440F, 1.436F, 1.369F}},
    {&CellPath::mass, {1.959F, 2.063F, -1.626F}},
    {&CellPath::chain, {2.004F, 1.562F, -0.888F}},
    {&CellPath::chain_mass, {0.7715F, 0.8626F, 1.002F}},
    {&CellPath::straight_short, {0.8464F, 0.08296F, -0.318F}},
    {&CellPath::straight_long, {0.7992F, 0.09439F, -0.265F}},
    {&CellPath::gap, {0.8606F, 0.6965F, 0.889F}},
    {&CellPath::bush_8, {0.7731F, 0.5515F, 0.041F}},
    {&CellPath::bush_16, {1.079F, 0.6568F, 0.332F}},
    {&CellPath::bush_32, {1.454F, 0.8011F, 0.783F}},
}};

}  // namespace

float logit_by_shape(const CellShape* shapes, const CellPath& path) {
    float sum = kBias + sum_of_terms(shapes, kShapeTerms);
    for (const PathTerm& p : kPathTerms)
        sum += value_of(path.*p.member, p.term);
    return sum;
}

}  // namespace treerec
