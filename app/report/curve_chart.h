// One measure over the walk: a curve for each run, on axes that all runs share.
//
// The picture is an SVG stretched to whatever width the page has; words lie over it as HTML, so that they are
// never stretched with it, can be read aloud and searched. Nothing of it needs a script.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "ridgeline/app/report/axis.h"
#include "ridgeline/app/report/decimation.h"
#include "ridgeline/app/report/walk_axis.h"

namespace ridgeline::app::report {

struct Curve {
    std::size_t run = 0;
    std::vector<Column> columns;
};

// A horizontal line: a capacity, a percentile.
struct Level {
    double value = 0.0;
    std::string label;  // HTML; empty: none
    std::string style;  // a class of the page's style, and that of a run
};

struct CurveChart {
    std::string title;
    std::string note;         // HTML, a line below the title
    std::string description;  // plain: what a reader who cannot see the picture is told
    Unit unit = Unit::count;
    Axis y;
    int height_px = 132;
    std::vector<Curve> curves;
    std::vector<Level> levels;
    std::string above;   // HTML between the title and the picture
    std::string beside;  // HTML in the margin at the right; empty: the runs' letters
    std::string style;   // more classes of the figure
};

std::string html(const CurveChart& chart, const WalkAxis& walk);

// The letter by which a run is called beside its colour.
std::string letter(std::size_t run);
// The class that gives its colour.
std::string colour_class(std::size_t run);

// "12.5%", for style attributes.
std::string percent_of(double share);

// Ticks and their words along an axis at the left or at the foot, for this chart and others.
std::string ticks_at_left(const Axis& y, Unit unit);
std::string ticks_at_foot(const Axis& x, Unit unit);
// The same as lines across a picture `columns` wide.
std::string grid_lines(const Axis& x, const Axis& y, int columns);

}  // namespace ridgeline::app::report
