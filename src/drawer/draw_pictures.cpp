// Part of the build: draws the pictures that the program, the editor's library and the addon carry.
#include <cstdio>

#include "error.h"
#include "exchange/material_textures.h"

int main(int argc, char** argv) {
    using namespace treerec;
    if (argc < 3) {
        std::fputs("usage: draw_pictures FOLDER PRESET...\n", stderr);
        return 2;
    }
    try {
        for (int i = 2; i < argc; i++) {
            write_pictures(argv[1], argv[i], draw_pictures(argv[i], kTextureSize, kTextureSeed));
            write_pictures(argv[1], argv[i], draw_sprays(argv[i], kTextureSize, kTextureSeed));
        }
    } catch (const Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
