// A folder of photos that a test draws itself, and their model.
#pragma once

#include "cli_runner.h"
#include "exchange/material_textures.h"
#include "geometry/parallel.h"
#include "photos/colmap_model.h"

namespace treerec::test {

class WithPhotos : public InFolder {
  protected:
    void TearDown() override {
        set_thread_count(0);
        InFolder::TearDown();
    }

    // That all photos are of: one without a lens.
    void use_pinhole(int width, int height, double focal) {
        Camera camera;
        camera.model = LensModel::kPinhole;
        camera.width = width;
        camera.height = height;
        camera.parameters = {focal, focal, width / 2.0, height / 2.0};
        model_.cameras = {camera};
    }

    void add_photo(const Photo& photo, const Image& picture) {
        write_png(path(photo.name), picture);
        model_.photos.push_back(photo);
    }

    PhotoModel model_;
};

}  // namespace treerec::test
