#include <doctest/doctest.h>

#include "cli/options.h"
#include "cli/run.h"

// What is refused, and how: exit code, one line, nothing left behind. Each case names the planted
// error that makes it fail. Where there are many cases the parser is asked in place: starting the
// program takes longer than all of them.

namespace {

/// What parse_options says against `solve box.obj` with more arguments; "" when it takes them.
std::string refusal(const std::vector<std::string>& more) {
    std::vector<const char*> arguments = {"parallux", "solve", "box.obj"};
    for (const std::string& argument : more)
        arguments.push_back(argument.c_str());
    try {
        parallux::parse_options(static_cast<int>(arguments.size()), arguments.data());
    } catch (const parallux::Error& error) {
        CHECK(error.fault() == parallux::Fault::usage);
        return error.what();
    }
    return "";
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace

// Planted: --version printed to standard error, or help that ends with a code.
TEST_CASE("help and version go to standard output with code 0") {
    Workplace place;
    CHECK(run(place, {"--version"}).out == "parallux 0.1.0\n");
    for (std::vector<std::string> arguments : {std::vector<std::string>{"--help"},
                                               {"info", "--help"},
                                               {"solve", "--help"},
                                               {"compare", "--help"}}) {
        Outcome outcome = run(place, arguments);
        CHECK(outcome.code == 0);
        CHECK(outcome.err == "");
        CHECK(outcome.out.find("Usage: parallux") != std::string::npos);
    }
}

// Planted: a parser that reads "-5" into an unsigned number, takes NaN, stops at the first bad
// character, or that lets one of two contradicting options win.
TEST_CASE("nonsense is refused with code 2, naming option and value") {
    Workplace place;
    struct Case {
        std::vector<std::string> arguments;
        std::string named;
    };
    const std::vector<Case> cases = {
        {{"--lines", "-5"}, "--lines -5"},
        {{"--lines", "0"}, "--lines 0"},
        {{"--lines", "1e3x"}, "--lines 1e3x"},
        {{"--lines", "99999999999999999999"}, "--lines 999"},
        {{"--bundles", "1.5"}, "--bundles 1.5"},
        {{"--patch-size", "nan"}, "--patch-size nan"},
        {{"--patch-size", "inf"}, "--patch-size inf"},
        {{"--patch-size", "0"}, "--patch-size 0"},
        {{"--patch-size", "-1"}, "--patch-size -1"},
        {{"--patches", "0"}, "--patches 0"},
        {{"--lines-per-patch", "-4"}, "--lines-per-patch -4"},
        {{"--line-spacing", "1e999"}, "--line-spacing 1e999"},
        {{"--threads", "-1"}, "--threads -1"},
        {{"--seed", "x"}, "--seed x"},
        {{"--batch", "0"}, "--batch 0"},
        {{"--max-memory", "4Q"}, "--max-memory 4Q"},
        {{"--max-memory", "0"}, "--max-memory 0"},
        {{"--time-limit", "-1"}, "--time-limit -1"},
        {{"--reflectance", "1"}, "--reflectance 1"},
        {{"--scale", "0"}, "--scale 0"},
        {{"--method", "magic"}, "--method magic"},
        {{"--direction", ""}, "--direction ''"},
        {{"--progress", "loud"}, "--progress loud"},
        {{"--image", "a.jpg"}, "--image a.jpg"},
        {{"--image", "a.png", "--size", "0x5"}, "--size 0x5"},
        {{"--image", "a.png", "--size", "99999"}, "--size 99999"},
        {{"--size", "640x480"}, "--image"},
        {{"--refresh", "1"}, "--image"},
        {{"--image", "a.png", "--refresh", "0"}, "--refresh 0"},
        {{"--image", "a.png", "--refresh", "1", "--groups", "1"}, "--refresh"},
        {{"--image", "a.png", "--refresh", "1", "--method", "lines"}, "--refresh"},
        {{"--table", "--stats"}, "--table --stats"},
        {{"--table"}, "--table"},
        {{"--seed", "1", "--seed", "2"}, "--seed"},
        {{"--patch-size", "1", "--patches", "5"}, "--patches"},
        {{"--bundles", "1", "--lines", "5"}, "--lines"},
        {{"--line-spacing", "1", "--lines-per-patch", "5"}, "--line-spacing"},
        {{"--quiet", "--progress", "on"}, "--quiet"},
        {{"--first-shot", "none", "--first-shot-rays", "5"}, "--first-shot-rays"},
        {{"--first-shot", "exact", "--first-shot-rays", "5"}, "--first-shot-rays"},
        {{"--method", "particles", "--sphere-radius", "5"}, "--sphere-radius"},
        {{"--sphere-radius", "9"}, "--sphere-radius"},
        {{"--sky", "blue"}, "--sky blue"},
        {{"--sky", "uniform"}, "--sky uniform"},
        {{"--sky", "uniform:-1"}, "--sky -1"},
        {{"--sky", "overcast:1:2"}, "--sky 2"},
        {{"--sky", "dark:1"}, "--sky dark:1"},
        {{"--sky", "image:"}, "--sky image:"},
        {{"--sky", "perez:100"}, "--sun"},
        {{"--sun", "40"}, "--sun 40"},
        {{"--sun", "91,0"}, "--sun 91"},
        {{"--sun", "40,0,-1"}, "--sun -1"},
        {{"--periodic", "5"}, "--periodic 5"},
        {{"--periodic", "0,0"}, "--periodic 0,0"},
        {{"--unheard-of"}, "--unheard-of"},
        {{"another.obj"}, "another.obj"},
    };
    for (const Case& one : cases) {
        std::string message = refusal(one.arguments);
        CAPTURE(one.named);
        CAPTURE(message);
        CHECK(contains(message, one.named));
        CHECK(!contains(message, "\n"));
    }
    CHECK(refusal({"--sky", "perez:100:0.2", "--sun", "40,180,600", "--periodic", "20,0"}) == "");
    CHECK(refusal({"--lines", "1e8", "--max-memory", "1.5GiB", "--exposure", "-1", "--image",
                   "a.png"}) == "");
    // Planted, seen: one tile alone predicted.
    Outcome outcome = run(place, {"info", place.scene(), "--predict", "--periodic", "2,2"});
    CHECK(outcome.code == 2);
    CHECK(outcome.one_line("periodic"));
    outcome = run(place, {"solve", place.scene(), "--lines", "-5"});
    CHECK(outcome.code == 2);
    CHECK(outcome.one_line("--lines -5"));
    CHECK(run(place, {}).code == 2);
    CHECK(run(place, {"solve"}).code == 2);
    CHECK(run(place, {"compare", "a.csv"}).code == 2);
    CHECK(place.files().empty());
}

// Planted, seen to fail: the contradiction with --fluxes left out.
TEST_CASE("what has no checkpoints refuses them") {
    CHECK(contains(refusal({"--checkpoint-every", "3"}), "--checkpoint"));
    for (const char* option : {"--checkpoint", "--resume"}) {
        const std::string message =
            refusal({option, "x.plx", "--temperatures", "t.csv", "--fluxes", "q.csv"});
        CHECK(contains(message, "--fluxes has no checkpoints"));
    }
}

// Planted: a loader's message passed on with the line breaks of a name in the scene.
TEST_CASE("an unreadable scene ends with code 3 and one line") {
    Workplace place;
    write_file(place / "junk.gltf", "{\"asset\": 7\n\n\x1b[31m}");
    write_file(place / "empty.obj", "");
    for (std::string name : {"missing.gltf", "junk.gltf", "empty.obj", "two\nlines.obj"})
        for (std::string command : {"info", "solve"}) {
            Outcome outcome = run(place, {command, place / name});
            CAPTURE(outcome.err);
            CHECK(outcome.code == 3);
            CHECK(outcome.one_line(name.substr(0, 3)));
        }
}

// Planted: the limit compared after the arrays are there, or never.
TEST_CASE("a solve above its memory limit does not start: code 5") {
    Workplace place;
    Outcome outcome = run(place, {"solve", place.scene(), "--max-memory", "1K", "--table",
                                  place / "t.csv", "--progress", "off"});
    CAPTURE(outcome.err);
    CHECK(outcome.code == 5);
    CHECK(outcome.one_line(""));
    CHECK(place.files().empty());
}

// Planted: a write to standard output whose result nobody looks at.
TEST_CASE("standard output that is full or closed ends with code 4") {
    Workplace place;
    for (std::string target : {"/dev/full", "-"}) {
        for (std::vector<std::string> arguments :
             {std::vector<std::string>{"--help"}, {"--version"}, {"info", place.scene()}}) {
            Outcome outcome = run(place, arguments, target);
            CAPTURE(outcome.err);
            CHECK(outcome.code == 4);
            CHECK(outcome.one_line("standard output"));
        }
    }
}
