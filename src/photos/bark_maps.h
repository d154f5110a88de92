// The steps from colours on a trunk to the pictures of a material.
#pragma once

#include <vector>

#include "geometry/vec.h"
#include "mesh/image.h"
#include "textures/textures.h"

namespace treerec {

// Numbers by pixel, rows from the top.
struct PixelField {
    int width = 0;
    int height = 0;
    std::vector<float> values;

    PixelField(int w, int h, float value = 0.0f)
        : width(w), height(h), values(static_cast<size_t>(w) * static_cast<size_t>(h), value) {}
    float& at(int x, int y) {
        return values[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)];
    }
    float at(int x, int y) const {
        return values[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)];
    }
};

// About what a Gaussian of these standard deviations (pixels) gives: three running means. wraps: the picture
// repeats; else it ends at its borders.
PixelField blurred(const PixelField& field, const DVec2& deviation, bool wraps);

// Divides the light's slow changes out of the colours: the luminance, as linear light, of what is about
// `deviation` pixels around is the same everywhere then, and the middle colour is kept. Where that is darker
// or lighter than any bark is, it is made as light as such bark. seen: by pixel; the others stay 0, and count
// nowhere. picture: RGB, sRGB.
// colour: 0..1, how far the colour's slow changes go with the light's.
void take_light_off(Image& picture, const std::vector<uint8_t>& seen, const DVec2& deviation, double colour,
                    bool wraps);

// By pixel: 0 where the colours around are the usual ones and sharp, up to .9 where they are unlike or
// blurred (moss, signs, sky beside an outline); 1 for what was not seen. deviation: of "around", pixels.
std::vector<float> faults_of(const Image& picture, const std::vector<uint8_t>& seen, const DVec2& deviation);

// Normal, occlusion and roughness of colours that repeat both ways, in the manner of make_bark_textures().
// metres: what a pixel is wide and high. detail: metres; what is finer in the photos is grain, and no relief.
// Where that is coarser than the pictures' pixels, noise takes its place in colour and relief.
BarkTextures maps_of(Image albedo, const DVec2& metres, double detail);

}  // namespace treerec
