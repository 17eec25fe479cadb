// SPDX-License-Identifier: GPL-3.0-or-later
// What a render tells of its photons themselves.
#include "parallel.h"
#include "render.h"

namespace photon_maps {

std::unique_ptr<const PhotonSnapshot> Render::snapshot(uint32_t index) {
    auto snapshot = std::make_unique<PhotonSnapshot>();
    const Radii radii = radii_of_pass(index);
    try {
        // The photons that the pass had, for they are a function of its index; then its maps.
        TracedPhotons all;
        for (PhotonTracing wanted : tracings(index)) {
            wanted.records_origins = true;
            TracedPhotons traced = trace_photons(scene_, emission_, wanted, &cancel_);
            snapshot->add(wanted, traced);
            const bool is_global = wanted.purpose == PhotonPurpose::global;
            for (size_t kind = 0; kind < all.photons.size(); ++kind)
                if (is_global != (kind == PM_PHOTONS_CAUSTIC)) all.photons[kind] = std::move(traced.photons[kind]);
            if (is_global) all.shadow_photons = std::move(traced.shadow_photons);
        }
        snapshot->maps = build_maps(all, radii, true);
        std::ranges::move(all.photons, snapshot->photons.begin());
    } catch (const Cancelled &) {
        cancel_ = false;
        throw;
    }
    snapshot->edges = edges_;
    snapshot->coverage = coverage_;
    snapshot->gathers = gathers_of(snapshot->maps, radii);
    return snapshot;
}

Vec3 Render::irradiance(const PhotonMap &map, pm_photon_kind kind, Vec3 point, Vec3 normal) const {
    Kernel kernel = settings_.kernel;
    kernel.radius = kind == PM_PHOTONS_CAUSTIC ? last_radii_.caustic : last_radii_.indirect;
    if (map.size() == 0 || !(kernel.radius > 0)) return {};
    const Query query{point, normal, normal};
    if (settings_.nearest_count > 0) kernel = kernel_of_nearest(map, query, settings_.nearest_count, kernel);
    return estimate_photons(map, *edges_, query, kernel).value;
}

}  // namespace photon_maps
