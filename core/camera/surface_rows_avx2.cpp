#include "core/camera/surface_rows_body.hpp"
#include "core/simd/lanes_avx2.hpp"

namespace pliant {

using RowsAvx2 = SurfaceRowsBody<LanesAvx2>;
const SurfaceRows kSurfaceRowsAvx2 = {&RowsAvx2::convert, &RowsAvx2::clean, &RowsAvx2::smooth};

}  // namespace pliant
