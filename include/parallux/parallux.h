#pragma once

/// \file Everything a user of the library needs, in the order of the flow.
#include "parallux/bake.h"
#include "parallux/changes.h"
#include "parallux/error.h"
#include "parallux/factors.h"
#include "parallux/lightmap.h"
#include "parallux/lines.h"
#include "parallux/patches.h"
#include "parallux/picture.h"
#include "parallux/predict.h"
#include "parallux/result.h"
#include "parallux/scene.h"
#include "parallux/sensors.h"
#include "parallux/solve.h"
#include "parallux/tables.h"
#include "parallux/thermal.h"
#include "parallux/transfer.h"
