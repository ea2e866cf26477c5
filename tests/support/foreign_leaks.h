#pragma once

// OpenImageIO keeps the text of an error that geterror() has fetched; the leak check is about our
// own memory. Included once in a program.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
    return "leak:libOpenImageIO\n";
}
