#include "core/track/patch_points.hpp"

#include <algorithm>

#include "core/track/model_tables.hpp"

namespace pliant {

void PatchPoints::lay_out(Workspace& workspace, std::size_t points) noexcept {
  const std::size_t most = points + (kBlock - 1) * limits::kMaxPatches;
  index = workspace.take<std::uint16_t>(most);
  for (auto* table : {&x, &y, &z, &nx, &ny, &nz}) *table = workspace.take<std::int16_t>(most);
}

void PatchPoints::start(const ModelTables& model) noexcept {
  const std::span<const std::uint8_t> patch_of = model.model->patch_of();
  count.fill(0);
  for (std::size_t i = 0; i < model.size; ++i) ++count[patch_of[i]];
  std::size_t end = 0;
  for (std::size_t p = 0; p < count.size(); ++p) {
    begin[p] = static_cast<std::uint16_t>(end);
    end += filled_up(count[p]);
    count[p] = 0;
  }
  for (auto* table : {&x, &y, &z, &nx, &ny, &nz}) std::fill(table->begin(), table->end(), std::int16_t{0});
  for (std::size_t i = 0; i < model.size; ++i) {
    const std::size_t p = patch_of[i], at = begin[p] + std::size_t{count[p]++};
    index[at] = static_cast<std::uint16_t>(i);
    x[at] = model.x[i];
    y[at] = model.y[i];
    z[at] = model.z[i];
    nx[at] = model.nx[i];
    ny[at] = model.ny[i];
    nz[at] = model.nz[i];
  }
}

}  // namespace pliant
