#include <string>

#include "output/factor_text.h"
#include "parallux/factors.h"

namespace parallux {

void write_factor_areas(const std::filesystem::path& file, const Factors& factors) {
    FactorText text(file);
    text.text("node,name,material,area,x,y,z,nx,ny,nz\n");
    for (std::size_t i = 0; i < factors.nodes.size(); ++i) {
        const FactorNode& node = factors.nodes[i];
        text.index(i).text(",").word(node.name).text(",").word(node.material).text(",");
        text.number(node.area);
        for (const glm::dvec3& v : {node.centre, node.normal})
            text.text(",").number(v.x).text(",").number(v.y).text(",").number(v.z);
        text.text("\n");
    }
    text.commit();
}

namespace {

void write_sky_row(const Factors& factors, std::size_t i, FactorText& text) {
    const std::uint32_t parts = factors.sky_parts;
    const double* outside = &factors.outside[i * factors.outsides()];
    double sky = 0;
    for (std::uint32_t k = 0; k < parts; ++k)
        sky += outside[k];
    text.index(i).text(",").number(sky).text(",");
    if (!factors.sky_error.empty())
        text.number(factors.sky_error[i]);
    text.text(",").number(outside[parts]).text(",").number(outside[parts + 1]);
    for (std::uint32_t k = 0; parts > 1 && k < parts; ++k) {
        text.text(",").number(outside[k]).text(",");
        if (!factors.outside_error.empty())
            text.number(factors.outside_error[i * factors.outsides() + k]);
    }
    text.text("\n");
}

}  // namespace

void write_sky_factors(const std::filesystem::path& file, const Factors& factors) {
    FactorText text(file);
    text.text("node,sky,stderr_sky,ground,backs");
    for (std::uint32_t k = 1; factors.sky_parts > 1 && k <= factors.sky_parts; ++k)
        text.text(",sky_").index(k).text(",stderr_").index(k);
    text.text("\n");
    for (std::size_t i = 0; i < factors.nodes.size(); ++i)
        write_sky_row(factors, i, text);
    text.commit();
}

}  // namespace parallux
