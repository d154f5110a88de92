// Keeps the surface from running into itself and into obstacles. Internal to growth/.
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <vector>

#include "growth/face_grid.h"
#include "growth/obstacles.h"
#include "growth/outlook.h"
#include "growth/surface.h"

namespace treerec::growth {

// A change of the surface that is not made yet: `replaced` go, `made` come, and one vertex stands elsewhere.
struct Change {
    std::vector<std::array<Vertex, 3>> made;
    std::vector<Face> replaced;
    Vertex moved = SurfaceMesh::null_vertex();
    DVec3 to{0.0};
    bool swept = false;   // the vertex gets there by the straight way, and nothing may lie on it
    bool sudden = false;  // larger than what the odometer tells of

    void clear() {
        made.clear();
        replaced.clear();
        moved = SurfaceMesh::null_vertex();
        swept = sudden = false;
    }
};

class Contact {
  public:
    // longest: T_s, metres; obstacles may be null and must outlive this.
    Contact(Surface& surface, double longest, const Obstacles* obstacles);

    // All faces that there are.
    void list_all();
    // Call list() for a face that is new or has changed, unlist() before one goes or changes its corners.
    void list(Face face) { list(face, surface_.normal_of(face)); }
    void list(Face face, const DVec3& normal);  // unit, outwards
    void unlist(Face face);

    // At the start of a step, in which no vertex but apical ones moves by more than `most` metres.
    void advance(double most);
    // Has all vertices that will move look around that must again; on several threads.
    void look_ahead();
    // Whether the vertex may go at once where it wants to in this step, whatever others do.
    bool may_go(const Cell& cell) const {
        return cell.safe_until >= odometer_ && cell.flat_until >= odometer_;
    }
    // After vertices that may were moved.
    void follow();
    // Moves the vertex, if nothing is in its way all along. sudden: by more than the odometer tells of.
    Hold move(Vertex vertex, const DVec3& to, bool sudden = false);
    // Which obstacle was in the way when it was last told so.
    int32_t touched() const { return touched_; }
    // Whether the change leaves a surface without folds that meets nothing.
    Hold check(const Change& change);
    // Calls take(face) for each face that may come into a ball; metres.
    template <typename Take>
    void visit(const DVec3& middle, double radius, Take take) const {
        grid_.visit(middle, radius, [&](uint32_t item) { take(Face(item)); });
    }
    // Of what changed its corners: its vertices must look around again,
    void look_again(Vertex vertex);
    // and with them those around it.
    void look_again_around(Vertex vertex);

  private:
    Hold check_near(const Change& change, const std::vector<DVec3>& normals);
    Hold check_far(const Change& change);
    Hold check_close(const Change& change);
    bool meets_obstacle(const DVec3 (&triangle)[3]);
    void warn_others();
    bool holds(Face face) const;
    // Until when nothing meets that is so many metres apart and comes nearer from both sides.
    double until(double distance) const { return odometer_ - most_ + 0.5 * (distance - gap_); }
    void leave_own_sheet();
    bool pair_meets(const Change& change, const std::array<Vertex, 3>& made, const DVec3& normal, Face face);
    bool made_meet(const Change& change, size_t a, size_t b, const std::vector<DVec3>& normals);
    DVec3 place(const Change& change, Vertex v) const {
        return v == change.moved ? change.to : surface_.place(v);
    }

    Surface& surface_;
    const Obstacles* obstacles_;
    FaceGrid grid_;
    const double reach_;   // metres around a change within which others are told to look again
    const double margin_;  // of the listed boxes
    const double gap_;     // kept between surfaces
    double odometer_ = 0.0;
    double most_ = 0.0;
    const Outlook outlook_;
    std::vector<std::unique_ptr<Outlook::Scratch>> scratches_;  // that no thread has
    std::mutex scratches_mutex_;
    uint32_t stamp_ = 0;
    int32_t touched_ = -1;
    Change moving_;
    std::vector<Face> near_, found_, sheet_;
    struct Close {
        Box box;
        DVec3 corners[3];
    };
    std::vector<Close> close_;       // of those found, what may touch
    std::vector<double> distances_;  // metres, of those found
    std::vector<DVec3> normals_;
};

}  // namespace treerec::growth
