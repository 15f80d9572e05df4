#include "core/camera/surface_rows_body.hpp"
#include "core/simd/lanes_sse41.hpp"

namespace pliant {

using RowsSse41 = SurfaceRowsBody<LanesSse41>;
const SurfaceRows kSurfaceRowsSse41 = {&RowsSse41::convert, &RowsSse41::clean, &RowsSse41::smooth};

}  // namespace pliant
