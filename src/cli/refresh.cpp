#include "cli/refresh.h"

#include <functional>
#include <string>

#include "cli/interrupt.h"
#include "cli/outputs.h"
#include "cli/terminal.h"

namespace parallux {

void Refresh::operator()(const Solution& so_far) {
    // Whoever has stopped the run waits for its end, not for a picture.
    if (interrupted())
        return;
    try {
        write_images(options_, scene_, patches_, so_far);
    } catch (const std::exception& failure) {
        if (told_)
            return;
        told_ = true;
        report_.end();
        complain(std::string("warning: ") + failure.what() + "; the picture was not refreshed");
    }
}

Preview Refresh::preview() {
    if (options_.refresh <= 0)
        return {};
    return {options_.refresh, std::ref(*this)};
}

}  // namespace parallux
