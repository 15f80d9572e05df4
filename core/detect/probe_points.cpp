// Written so that the compiler makes vectors of the loops: no jumps, choices between values at hand.
#include "core/detect/probe_points.hpp"

#include <algorithm>

namespace pliant {

void ProbePoints::lay_out(Workspace& workspace, std::size_t count) noexcept {
  const std::size_t room = (count + kBlock - 1) / kBlock * kBlock;
  for (std::span<float>* array : {&x_, &y_, &z_, &nx_, &ny_, &nz_}) *array = workspace.take<float>(room);
}

void ProbePoints::start(const ModelView& model) noexcept {
  centre_ = model.centre();
  radius_ = model.radius();
  count_ = std::min(x_.size(), model.size());
  constexpr float kQ14 = 1.0F / 16384;
  for (std::size_t i = 0; i < x_.size(); ++i) {
    const bool any = i < count_;
    const Point3f p = any ? model.positions()[i] : Point3f();
    const Normal16 n = any ? model.normals()[i] : Normal16();
    x_[i] = p.x;
    y_[i] = p.y;
    z_[i] = p.z;
    nx_[i] = static_cast<float>(n.x) * kQ14;
    ny_[i] = static_cast<float>(n.y) * kQ14;
    nz_[i] = static_cast<float>(n.z) * kQ14;
  }
}

void ProbePoints::pose_block(const FastTransform& pose, std::size_t first, Posed& out) const noexcept {
  const float *px = x_.data() + first, *py = y_.data() + first, *pz = z_.data() + first;
  const float *qx = nx_.data() + first, *qy = ny_.data() + first, *qz = nz_.data() + first;
  const FastTransform f = pose;  // nothing that is written below can be part of it
#pragma GCC ivdep
  for (std::size_t k = 0; k < kBlock; ++k) {
    const float x = f.r[0] * px[k] + f.r[1] * py[k] + f.r[2] * pz[k] + f.t[0];
    const float y = f.r[3] * px[k] + f.r[4] * py[k] + f.r[5] * pz[k] + f.t[1];
    const float z = f.r[6] * px[k] + f.r[7] * py[k] + f.r[8] * pz[k] + f.t[2];
    const float u = f.r[0] * qx[k] + f.r[1] * qy[k] + f.r[2] * qz[k];
    const float v = f.r[3] * qx[k] + f.r[4] * qy[k] + f.r[5] * qz[k];
    const float w = f.r[6] * qx[k] + f.r[7] * qy[k] + f.r[8] * qz[k];
    const float facing = u * x + v * y + w * z;
    const std::int32_t towards = facing < 0 ? 1 : 0;
    const std::int32_t enough = facing * facing >= kFacing * (x * x + y * y + z * z) ? 1 : 0;
    out.x[k] = x;
    out.y[k] = y;
    out.z[k] = z;
    out.nx[k] = u;
    out.ny[k] = v;
    out.nz[k] = w;
    out.facing[k] = facing;
    out.ask[k] = towards & enough;
  }
}

}  // namespace pliant
