#include "scene/loaders.h"
namespace parallux {
void read_parallux(SceneBuilder&, const Json& j) {
    JsonView("x", j).fail("x");
}
}  // namespace parallux
