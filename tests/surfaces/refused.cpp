#include <doctest/doctest.h>

#include <string>

#include "scene/scene_files.h"

// Curved surfaces that cannot be: one line that names the file, the place and what is wrong. The
// program ends with 3 on every one of them (Fault::input, tests/cli).

using namespace parallux;

namespace {

std::string scene(const std::string& surface, const std::string& more = "") {
    return R"({"parallux": 1, "bands": 1, "materials": [], "surfaces": [{)" + surface + "}]" +
           more + "}";
}

}  // namespace

TEST_CASE("curved surfaces that cannot be are refused, in one line") {
    struct Case {
        const char *surface, *says;
    };
    const Case cases[] = {
        {R"("disk": {"centre": [0,0,0], "normal": [0,0,1], "radius": 1, "inner": 1})",
         "/surfaces/0/disk/inner: must be less than the radius"},
        {R"("disk": {"centre": [0,0,0], "normal": [0,0,0], "radius": 1})",
         "/surfaces/0/disk/normal: must not be zero"},
        {R"("disk": {"centre": [0,0,0], "normal": [0,0,1], "radius": 1, "start": [0,0,2]})",
         "/surfaces/0/disk/start: must not lie along the axis"},
        {R"("disk": {"normal": [0,0,1], "radius": 1})", "/surfaces/0/disk"},
        {R"("sphere": {"centre": [0,0,0], "radius": 0})", "/surfaces/0/sphere/radius"},
        {R"("sphere": {"centre": [0,0,0], "radius": -1})", "/surfaces/0/sphere/radius"},
        {R"("sphere": {"centre": [0,0,1e16], "radius": 1})", "/surfaces/0/sphere/centre"},
        {R"("sphere": {"centre": [0,0,0], "radius": 1, "tube": 1})", "unknown key"},
        {R"("sphere": {"centre": [0,0,0], "radius": 1, "angle": 361})", "/surfaces/0/sphere/angle"},
        {R"("sphere": {"centre": [0,0,0], "radius": 1}, "trim": [[0,0], [0,1]])",
         "/surfaces/0/trim: its first point must be less than its second"},
        {R"("sphere": {"centre": [0,0,0], "radius": 1}, "trim": [[0,0], [1,2]])",
         "/surfaces/0/trim"},
        {R"("sphere": {"centre": [0,0,0], "radius": 1}, "trim": [0,1])", "/surfaces/0/trim"},
        {R"("sphere": {"centre": [0,0,0], "radius": 1}, "grid": [0,1])",
         "/surfaces/0/grid: must be 1 or more"},
        {R"("sphere": {"centre": [0,0,0], "radius": 1}, "grid": [40000,1])", "/surfaces/0/grid"},
        {R"("sphere": {"centre": [0,0,0], "radius": 1},
            "disk": {"centre": [0,0,0], "normal": [0,0,1], "radius": 1})",
         "must have one of"},
        {R"("torus": {"centre": [0,0,0], "axis": [0,0,1], "radius": 1, "tube": 2})",
         "/surfaces/0/torus/tube: must not be more than the radius"},
        {R"("cylinder": {"base": [0,0,0], "axis": [0,0,0], "radius": 1})",
         "/surfaces/0/cylinder/axis: must not be zero"},
        {R"("cone": {"base": [0,0,0], "axis": [0,0,1], "radius": 1, "top": -1})",
         "/surfaces/0/cone/top"},
        {R"("bilinear": [[0,0,0], [1,0,0], [1,1,0]])", "/surfaces/0/bilinear: must have four"},
        {R"("bicubic": [[0,0,0], [1,0,0], [1,1,0], [0,1,0]])",
         "/surfaces/0/bicubic: must have sixteen"},
        {R"("bilinear": [[0,0,0], [1,0,0], [1,0,0], [0,0,0]])", "has no area"},
        {R"("swept": {"profile": [[0,0,0], [1,0,0], [2,0,0]], "sweep": [0,1,0]})",
         "/surfaces/0/swept/profile: must have 2 points"},
        {R"("revolved": {"base": [0,0,0], "axis": [0,0,1], "profile": [[-1,0], [1,1]]})",
         "/surfaces/0/revolved/profile/0/0"},
        {R"("parallelogram": [[0,0,0], [1,0,0], [0,1,0]], "trim": [[0,0], [0.5,1]])",
         "/surfaces/0/trim: is for curved surfaces only"},
    };
    TestFolder folder;
    for (const Case& c : cases) {
        CAPTURE(c.surface);
        const std::string says = fault_of(folder.write("x.json", scene(c.surface)));
        CAPTURE(says);
        CHECK(holds(says, c.says));
    }
}
