// Where a store's nodes lie in one view's drawn frame, and at which distances they switch there. Internal to
// the room; constant while a selection runs.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <span>

#include "ridgeline/base/geometry.h"
#include "ridgeline/io/grid.h"
#include "ridgeline/io/node_record.h"
#include "ridgeline/io/terrain_info.h"
#include "ridgeline/select/frame_tree.h"
#include "ridgeline/select/horizon.h"
#include "ridgeline/select/view.h"

namespace ridgeline::select {

class TerrainFrame {
  public:
    TerrainFrame(const io::TerrainInfo& info, std::span<const io::NodeRecord> records)
        : info_(info), grid_(info.grid()), records_(records) {
        for (int level = 0; level <= grid_.levels(); ++level) {
            // One level past the finest: the squares of its quarters.
            const double samples = std::ldexp(grid_.quads(), grid_.finest() - level);
            side_m_[static_cast<std::size_t>(level)] =
                samples * glm::dvec2(info.spacing_x_m, info.spacing_y_m);
        }
    }

    void set_view(const View& view, const SwitchingRule& rule) {
        eye_m_ = view.eye_m;
        quantum_m_ = info_.quantum_m * view.exaggeration;
        pixels_per_error_m_ = view.exaggeration * view.projection_px;
        rule_ = rule;
        beside_m_ = view.beside_finest_m;
    }

    const io::TerrainInfo& info() const { return info_; }
    const io::Grid& grid() const { return grid_; }
    const io::NodeRecord& record(NodeIndex index) const { return records_[index]; }

    // Bounds the node's mesh in every morph state.
    Box box(const Visit& v) const { return box_of(v.node, v.index); }
    // Bounds a quarter of it.
    Box quarter_box(const Visit& v, int quarter) const { return box_of(v.node.child(quarter), v.index); }
    // What may be drawn of the ground in a box, whoever draws it.
    Box drawn_box(Box box) const {
        box.min.z -= beside_m_;
        box.max.z += beside_m_;
        return box;
    }
    // Whether a quarter touches the raster; above the finest level the same as that the child exists.
    bool quarter_exists(io::NodeId node, int quarter) const {
        const std::int64_t half = grid_.extent(node.level) / 2;
        const io::NodeId square = node.child(quarter);
        return square.x * half < grid_.width() - 1 && square.y * half < grid_.height() - 1;
    }

    // A node's square as `cells` by `cells`, and a height, as the eye has them.
    Lattice lattice(io::NodeId node, int cells) const {
        const glm::dvec2& side = side_m_[static_cast<std::size_t>(node.level)];
        return {{info_.west_m + node.x * side.x - eye_m_.x, info_.north_m - node.y * side.y - eye_m_.y},
                side / static_cast<double>(cells)};
    }
    double over_eye_m(double quanta) const { return info_.height_offset_m + quanta * quantum_m_ - eye_m_.z; }
    double quantum_m() const { return quantum_m_; }  // with exaggeration

    double distance_m(const Visit& v) const { return distance(eye_m_, box(v)); }
    double diagonal_m(const Visit& v) const {
        const glm::dvec2& side = side_m_[static_cast<std::size_t>(v.node.level)];
        const io::NodeRecord& r = record(v.index);
        const double rise = (r.max_quanta - static_cast<double>(r.min_quanta)) * quantum_m_;
        return std::sqrt(side.x * side.x + side.y * side.y + rise * rise);
    }

    // The distance within which the criterion splits the node; 0 where it never does.
    double split_m(const Visit& v) const {
        const io::NodeRecord& r = record(v.index);
        return v.node.level < grid_.finest() && r.has_data() ? rule_.distance_m(r.error_m, v.node.level)
                                                             : 0.0;
    }
    // Whether the criterion splits the node; asked of every candidate all around the eye, so without a root.
    bool splits(const Visit& v) const {
        const double within_m = split_m(v);
        const Box b = box(v);
        const double east = std::max({b.min.x - eye_m_.x, eye_m_.x - b.max.x, 0.0});
        const double north = std::max({b.min.y - eye_m_.y, eye_m_.y - b.max.y, 0.0});
        const double up = std::max({b.min.z - eye_m_.z, eye_m_.z - b.max.z, 0.0});
        return east * east + north * north + up * up < within_m * within_m;
    }
    // The distance beyond which the node's parent stands for it.
    double merge_m(const Visit& v) const {
        return v.node.level == 0 ? std::numeric_limits<double>::infinity()
                                 : split_m(visit(grid_, v.node.parent()));
    }

    // Pixels that a node's error covers from a distance.
    double error_px(NodeIndex index, double at_m) const {
        constexpr double kNearest_m = 0.01;  // the eye may stand in the box
        return pixels_per_error_m_ * static_cast<double>(record(index).error_m) / std::max(at_m, kNearest_m);
    }

  private:
    Box box_of(io::NodeId square, NodeIndex heights_of) const {
        const io::NodeRecord& r = record(heights_of);
        const glm::dvec2& side = side_m_[static_cast<std::size_t>(square.level)];
        return {{info_.west_m + square.x * side.x, info_.north_m - (square.y + 1.0) * side.y,
                 info_.height_offset_m + r.min_quanta * quantum_m_},
                {info_.west_m + (square.x + 1.0) * side.x, info_.north_m - square.y * side.y,
                 info_.height_offset_m + r.max_quanta * quantum_m_}};
    }

    const io::TerrainInfo& info_;
    io::Grid grid_;
    std::span<const io::NodeRecord> records_;
    // Of a node of each level, metres east and south.
    std::array<glm::dvec2, io::Grid::kMaxLevels + 1> side_m_{};
    glm::dvec3 eye_m_{0.0};
    double quantum_m_ = 1.0;
    double beside_m_ = 0.0;  // View::beside_finest_m
    double pixels_per_error_m_ = 1.0;
    SwitchingRule rule_;
};

}  // namespace ridgeline::select
