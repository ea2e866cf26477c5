#include "efficiency/methods.h"

#include <algorithm>
#include <cstdio>

#include "efficiency/reference.h"
#include "parallux/error.h"

namespace parallux::efficiency {

SolveSettings Contender::run(std::uint64_t length, std::uint64_t seed) const {
    SolveSettings own = settings;
    (by_bundles() ? own.bundles : own.lines) = length;
    own.seed = seed;
    return own;
}

namespace {

std::vector<Contender> all_contenders(const Case& of, unsigned threads) {
    std::vector<Contender> all;
    auto add = [&](const char* name, Method method, FirstShot first_shot) -> SolveSettings& {
        all.push_back({name, {}});
        all.back().settings.method = method;
        all.back().settings.first_shot = first_shot;
        all.back().settings.threads = threads;
        return all.back().settings;
    };
    const bool exact = exact_is_affordable(of);
    add(baseline, Method::lines, FirstShot::off).threads = 1;
    add("paper-first-shot", Method::lines, exact ? FirstShot::exact : FirstShot::rays);
    add("lines-oriented", Method::lines, FirstShot::off).direction = Direction::oriented;
    add(default_method, Method::bundles, FirstShot::automatic);
    add("bundles-no-shot", Method::bundles, FirstShot::off);
    add("bundles-rays", Method::bundles, FirstShot::rays);
    if (exact)
        add("bundles-exact", Method::bundles, FirstShot::exact);
    else
        std::printf("%s: no exact first shot, %llu emitting surfaces x %zu patches are too many\n",
                    of.name.c_str(), static_cast<unsigned long long>(of.emitters),
                    of.patches.count());
    add("bundles-random", Method::bundles, FirstShot::automatic).directions = DirectionSet::random;
    add("bundles-no-gather", Method::bundles, FirstShot::automatic).gather_share = 0;
    add("progressive", Method::progressive, FirstShot::automatic);
    add("particles", Method::particles, FirstShot::automatic);
    if (of.patches.count() <= 2000)
        add("matrix", Method::matrix, FirstShot::automatic);
    return all;
}

}  // namespace

std::vector<Contender> contenders(const Case& of, unsigned threads,
                                  const std::vector<std::string>& names) {
    std::vector<Contender> all = all_contenders(of, threads);
    if (names.empty())
        return all;
    for (const std::string& name : names)
        if (std::none_of(all.begin(), all.end(),
                         [&](const Contender& c) { return c.name == name; }))
            throw Error(Fault::usage, "no method '" + name + "' for " + of.name);
    std::erase_if(all, [&](const Contender& c) {
        return c.name != baseline && std::find(names.begin(), names.end(), c.name) == names.end();
    });
    return all;
}

}  // namespace parallux::efficiency
