#include "growth/trace.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "file_bytes.h"

namespace treerec::growth {

namespace {

// The shortest text that is read as the same number.
template <typename Number>
void put(std::string& text, Number value) {
    char digits[40];
    const auto end = std::to_chars(digits, digits + sizeof(digits), value);
    text.append(digits, end.ptr);
    text += ',';
}

void put(std::string& text, const DVec3& value) {
    put(text, value.x);
    put(text, value.y);
    put(text, value.z);
}

const char* name_of(Tissue tissue) {
    return tissue == Tissue::kApical ? "AM" : tissue == Tissue::kCambium ? "CA" : "XY";
}

const char* name_of(Hold hold) {
    switch (hold) {
        case Hold::kFree:
            return "free";
        case Hold::kFold:
            return "fold";
        case Hold::kSurface:
            return "surface";
        case Hold::kObstacle:
            break;
    }
    return "obstacle";
}

}  // namespace

void write_trace(const std::string& folder, const Surface& surface, int step, double shortest) {
    std::string vertices = "id,type,owner,x,y,z,vx,vy,vz,speed,pieces,tox,toy,toz,hold\n";
    for (const Vertex v : surface.mesh.vertices()) {
        const Cell& cell = surface.cells[v];
        put(vertices, cell.id);
        vertices += name_of(cell.tissue);
        vertices += ',';
        put(vertices, cell.owner);
        put(vertices, cell.previous);
        put(vertices, cell.velocity);
        put(vertices, cell.speed);
        put(vertices, pieces_of(cell, shortest));
        put(vertices, surface.place(v));
        vertices += name_of(cell.hold);
        vertices += '\n';
    }
    std::string faces = "a,b,c\n";
    for (const Face face : surface.mesh.faces()) {
        Vertex corners[3];
        surface.corners(face, corners);
        for (const Vertex corner : corners)
            put(faces, surface.cells[corner].id);
        faces.back() = '\n';
    }
    char name[32];
    std::snprintf(name, sizeof(name), "step_%05d", step);
    const std::string path = folder + "/" + name;
    write_file(path + ".csv", vertices);
    write_file(path + "_faces.csv", faces);
}

}  // namespace treerec::growth
