#include "core/camera/surface_rows_body.hpp"
#include "core/simd/lanes_neon.hpp"

namespace pliant {

using RowsNeon = SurfaceRowsBody<LanesNeon>;
const SurfaceRows kSurfaceRowsNeon = {&RowsNeon::convert, &RowsNeon::clean, &RowsNeon::smooth};

}  // namespace pliant
