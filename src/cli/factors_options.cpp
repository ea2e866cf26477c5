#include "cli/factors_options.h"

#include "cli/option_group.h"
#include "cli/sky_options.h"
#include "cli/values.h"
#include "vectors.h"

namespace parallux {

namespace {

// Longer than any scene: a surface is one cell.
constexpr double one_cell = 1e15;

std::filesystem::path parse_file(const std::string& option, const std::string& value,
                                 std::initializer_list<const char*> endings) {
    if (value.empty() || value.starts_with("--"))
        refuse(option, value, "expected a file name");
    const std::filesystem::path file = value;
    std::string words;
    for (const char* ending : endings) {
        if (file.extension() == ending)
            return file;
        words += (words.empty() ? "" : " or ") + std::string(ending);
    }
    refuse(option, value, "expected a name that ends in " + words);
}

void add_scene(CLI::App& app, FactorsOptions& o) {
    app.add_option("SCENE", o.scene, "glTF (.gltf, .glb), OBJ, STL or Parallux (.json) scene")
        ->required()
        ->type_name("");
    const OptionGroup option{app, "Scene"};
    option("--scale", "X", "Metres per unit of the scene file [1]",
           [&o](auto& v) { o.load.scale = parse_positive("--scale", v); });
    option("--periodic", "X,Y",
           "The scene repeats without end after so many of its units along x and y (z "
           "where y is up); 0: not that way",
           [&o](auto& v) { o.load.period = parse_period("--periodic", v); });
    option("--exclude", "NAMES", "Leave out objects or materials of these names: a,b*",
           [&o](auto& v) { o.exclude = parse_names("--exclude", v); });
}

void add_outputs(CLI::App& app, FactorsOptions& o) {
    const OptionGroup option{app, "Outputs"};
    option("-o,--output", "F.mtx|F.npz",
           "Matrix Market, or NumPy as scipy.sparse.load_npz reads it; F.areas.csv beside it",
           [&o](auto& v) {
               o.matrix = parse_file("-o", v, {".mtx", ".npz"});
           });
    option("--values", "V",
           "exchange: areas A_i F_ij in m², symmetric to the bit; or factors: F_ij [exchange]",
           [&o](auto& v) {
               o.values = parse_choice<FactorValues>(
                   "--values", v,
                   {{"exchange", FactorValues::exchange}, {"factors", FactorValues::factors}});
           });
    option("--sky", "F.csv", "Factors to the sky, the ground and inert backs, a row a node",
           [&o](auto& v) { o.sky = parse_file("--sky", v, {".csv"}); });
    option("--stats", "F.json", "Row sums, reciprocity, errors, unresolved lines, memory",
           [&o](auto& v) { o.stats = parse_file("--stats", v, {".json"}); });
}

void add_nodes(CLI::App& app, FactorsOptions& o) {
    const OptionGroup option{app, "Between"};
    option("--between", "B", "patches, surfaces, objects or materials [patches]", [&o](auto& v) {
        o.factors.between = parse_choice<FactorNodes>("--between", v,
                                                      {{"patches", FactorNodes::patches},
                                                       {"surfaces", FactorNodes::surfaces},
                                                       {"objects", FactorNodes::objects},
                                                       {"materials", FactorNodes::materials}});
    });
    auto* size = option("--patch-size", "L", "Wanted side, in the scene's units", [&o](auto& v) {
        o.patches.size = parse_positive("--patch-size", v);
        o.patches_asked = true;
    });
    auto* count = option("--patches", "N", "Wanted number in all [10000]", [&o](auto& v) {
        o.patches.count = parse_count("--patches", v, 1, 0x7fffffff);
        o.patches_asked = true;
    });
    size->excludes(count);
    app.add_flag_callback(
           "--no-clusters", [&o] { o.patches.clusters = false; },
           "Give every fine triangle a patch of its own")
        ->group(option.name);
    app.add_flag("--facets", o.facets,
                 "Every triangle of the file is one patch, in the file's order")
        ->excludes(size)
        ->excludes(count)
        ->group(option.name);
    option("--sky-parts", "P", "whole, tregenza (145) or reinhart (577) [whole]", [&o](auto& v) {
        o.factors.sky_parts = parse_choice<SkyParts>("--sky-parts", v,
                                                     {{"whole", SkyParts::whole},
                                                      {"tregenza", SkyParts::tregenza},
                                                      {"reinhart", SkyParts::reinhart}});
    });
    option("--sky-from", "S",
           "lines, or points on each patch; auto: points where they cost little [auto]",
           [&o](auto& v) {
               o.factors.sky_from = parse_choice<SkyFrom>("--sky-from", v,
                                                          {{"auto", SkyFrom::automatic},
                                                           {"lines", SkyFrom::lines},
                                                           {"points", SkyFrom::points}});
           });
    option("--threshold", "T",
           "Leave out factors below T both ways; what they had goes to the others of the row [0]",
           [&o](auto& v) { o.factors.threshold = parse_real("--threshold", v, 0, 1); });
}

void add_lines(CLI::App& app, FactorsOptions& o) {
    FactorSettings& s = o.factors;
    const OptionGroup option{app, "Lines"};
    option("--bundles", "D", "Directions of parallel lines [4096]",
           [&s](auto& v) { s.bundles = parse_count("--bundles", v, 1); });
    auto* spacing = option("--line-spacing", "L", "Between a bundle's lines, in the scene's units",
                           [&s](auto& v) { s.line_spacing = parse_positive("--line-spacing", v); });
    option("--lines-per-patch", "C", "Lines of a bundle over a mean patch's area [4 to 64]",
           [&s](auto& v) { s.lines_per_patch = parse_positive("--lines-per-patch", v); })
        ->excludes(spacing);
    option("--groups", "R", "Parts of the bundles whose spread tells the error; 1: unknown [8]",
           [&s](auto& v) {
               s.groups = static_cast<std::uint32_t>(parse_count("--groups", v, 1, 64));
           });
    option("--seed", "S", "Equal seeds give equal results, whatever the threads [1]",
           [&s](auto& v) { s.seed = parse_count("--seed", v, 0); });
}

void add_run(CLI::App& app, FactorsOptions& o) {
    const OptionGroup option{app, "Run"};
    option("--threads", "T", "0: all [0]", [&o](auto& v) {
        o.factors.threads = static_cast<unsigned>(parse_count("--threads", v, 0, 4096));
    });
    option("--vectors", "SET", "Instruction set: auto, plain, sse4, avx2 or avx512 [auto]",
           [](auto& v) {
               if (!use_vectors(v.c_str()))
                   refuse("--vectors", v,
                          "expected auto, plain, sse4, avx2 or avx512, as far as "
                          "this machine has them");
           });
    option("--max-memory", "M", "Refuse above this: 500M, 4GiB [what the machine has]",
           [&o](auto& v) { o.factors.max_memory = parse_bytes("--max-memory", v); });
    app.add_flag("--quiet", o.quiet, "No progress, summary or warnings; failures are still told")
        ->group(option.name);
}

}  // namespace

std::filesystem::path FactorsOptions::areas() const {
    std::filesystem::path file = matrix;
    return matrix.empty() ? file : file.replace_extension(".areas.csv");
}

CLI::App* add_factors(CLI::App& app, FactorsOptions& options) {
    auto* factors =
        app.add_subcommand("factors", "Form factors between parts of a scene, and to the sky");
    add_scene(*factors, options);
    add_outputs(*factors, options);
    add_nodes(*factors, options);
    add_lines(*factors, options);
    add_run(*factors, options);
    return factors;
}

void settle(FactorsOptions& o) {
    if (o.matrix.empty() && o.sky.empty())
        throw Error(Fault::usage,
                    "factors needs -o F.mtx, -o F.npz or --sky F.csv; try parallux "
                    "factors --help");
    o.patches.size *= o.load.scale;
    o.factors.line_spacing *= o.load.scale;
    o.load.keep_triangles = o.facets;
    // Lines are counted between groups whole: their parts are of no use.
    const bool whole = o.factors.between != FactorNodes::patches && !o.patches_asked;
    if (o.facets || whole) {
        o.patches.size = one_cell;
        o.patches.clusters = false;
    }
}

}  // namespace parallux
