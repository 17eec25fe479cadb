// SPDX-License-Identifier: GPL-3.0-or-later
// One photon on its way from a light.
#include "photon_trace.h"
#include "ray_state.h"

namespace photon_maps {

namespace {

void add(Flux &sum, Vec3 flux) {
    sum[0] += static_cast<double>(flux.x);
    sum[1] += static_cast<double>(flux.y);
    sum[2] += static_cast<double>(flux.z);
}

/// By what flux changes where the shading normal differs from the geometric one: photons land and leave by the latter
/// (Veach 1997, section 5.3). Light from before the one and behind the other brings nothing.
float normal_correction(const SurfacePoint &hit, Vec3 arriving, Vec3 leaving) {
    if (hit.shading_normal == hit.normal) return 1;
    const auto ratio = [](float wanted, float given) {
        return given > 0 ? shading_ratio(wanted, given) : shading_ratio(-wanted, -given);
    };
    return ratio(dot(arriving, hit.shading_normal), dot(arriving, hit.normal)) *
           ratio(dot(leaving, hit.normal), dot(leaving, hit.shading_normal));
}

/// One photon on its way.
class PhotonPath {
  public:
    PhotonPath(const Scene &scene, const PhotonTracing &tracing, Sequence &sequence, TracedPhotons &traced)
        : scene_(scene), tracing_(tracing), sequence_(sequence), traced_(traced) {}

    void trace(const PhotonEmission &emission, uint64_t number) {
        number_ = static_cast<uint32_t>(number);
        label_ = emission.label;
        ray_ = emission.ray;
        flux_ = emission.flux / static_cast<float>(tracing_.count);
        // Up to its first scattering a photon goes the way of a shadow ray, and passes what lets those pass.
        state_.kinds = 1u << PM_RAY_SHADOW | 1u << PM_RAY_DIFFUSE;
        source_visibility_ = emission.visibility;
        source_ = emission.source;
        while (step(emission)) {
        }
    }

  private:
    bool step(const PhotonEmission &emission) {
        SurfacePoint hit;
        ++traced_.rays;
        const bool met = scene_.intersect(ray_, hit);
        if (state_.depth == 0 && state_.transparent_depth == 0) leave_light(emission, met ? &hit : nullptr);
        if (!met) {
            add(traced_.balance.escaped, flux_);
            return false;
        }
        if (tracing_.records_segments)
            traced_.segments.push_back({ray_.origin, hit.position, flux_, origin(hit), state_.depth});
        state_.length += hit.distance;
        if (tracing_.records_origins) add_received(hit);
        const uint32_t kind = 1u << (state_.depth == 0 ? PM_RAY_SHADOW : PM_RAY_DIFFUSE);
        if (!(scene_.instances[hit.instance].visibility & kind)) pass_by(hit);
        if (tracing_.leaves_shadow_photons && state_.depth == 0) mark_shadows(hit);
        const Shading shading = shade(scene_, hit, -ray_.direction, state_);
        record(hit, shading);
        return scatter(hit, shading);
    }

    PhotonOrigin origin(const SurfacePoint &hit) const { return {number_, label_, hit.instance}; }

    void add_received(const SurfacePoint &hit) {
        Received &received = traced_.received[{hit.instance, label_}];
        ++received.arrived;
        add(received.flux, flux_);
    }

    /// An object that shadow rays, or the rays that would come here, do not see is lit, and so is what lies behind it:
    /// a second photon goes on.
    void pass_by(const SurfacePoint &hit) const {
        if (state_.transparent_depth == max_transparent_depth) return;
        PhotonPath beyond = *this;
        beyond.ray_.origin = hit.origin_towards(ray_.direction);
        beyond.state_ = passed(state_);
        while (beyond.step({})) {
        }
    }

    /// Leaves a photon of the light's sight, and for the first surface that stops it those of its shadow.
    void mark_shadows(const SurfacePoint &hit) {
        const auto source = static_cast<uint32_t>(source_);
        traced_.shadow_photons.push_back({hit.position, source & 0x7fffffff, 1});
        if (tracing_.records_origins) traced_.shadow_origins.push_back(origin(hit));
        if (casts_shadow_ || !(scene_.instances[hit.instance].visibility & 1u << PM_RAY_SHADOW)) return;
        casts_shadow_ = true;
        constexpr int most_surfaces = 64;
        Ray beyond = ray_;
        SurfacePoint last = hit;
        for (int surface = 0; surface < most_surfaces; ++surface) {
            beyond.origin = last.origin_towards(beyond.direction);
            ++traced_.rays;
            if (!scene_.intersect(beyond, last)) return;
            traced_.shadow_photons.push_back({last.position, source & 0x7fffffff, 0});
            if (tracing_.records_origins) traced_.shadow_origins.push_back(origin(last));
        }
    }

    void leave_light(const PhotonEmission &emission, const SurfacePoint *hit) {
        if (hit && emission.falloff_radius_squared > 0) {
            const float squared = length_squared(hit->position - emission.falloff_center);
            flux_ = flux_ * (squared / (squared + emission.falloff_radius_squared));
        }
        add(traced_.balance.emitted, flux_);
    }

    /// Records the photon as it arrives, if its word is one that it is traced for: on what a diffuse ray would come to
    /// its source from.
    void record(const SurfacePoint &hit, const Shading &shading) {
        if (!(lobes_of(shading) & diffuse_lobes & lobes_that_see(source_visibility_))) return;
        const bool is_direct = state_.depth == 0, is_caustic = !is_direct && !was_diffuse_;
        if (is_caustic != (tracing_.purpose == PhotonPurpose::caustic)) return;
        if (is_direct && !tracing_.records_direct) return;
        const auto kind = is_direct ? PM_PHOTONS_DIRECT : is_caustic ? PM_PHOTONS_CAUSTIC : PM_PHOTONS_INDIRECT;
        traced_.photons[kind].push_back({hit.position, flux_,
                                         pack_normal(hit.normal, std::min<uint32_t>(state_.depth, 255u)),
                                         pack_direction(ray_.direction)});
        if (!tracing_.records_origins) return;
        traced_.origins[kind].push_back(origin(hit));
        ++traced_.received[{hit.instance, label_}].stored;
    }

    /// Sends the photon on, or ends it.
    bool scatter(const SurfacePoint &hit, const Shading &shading) {
        const Lobes wanted = tracing_.purpose == PhotonPurpose::caustic ? glossy_lobes : all_lobes;
        const Lobes lobes = wanted & lobes_that_see(source_visibility_);
        const Vec3 before = flux_;
        const auto u = sequence_.next();

        // Straight on, or by a closure.
        const float straight = average(shading.transparency), scattering = average(albedo(shading, lobes));
        if (!(straight + scattering > 0)) return end(before, {});
        const float go_straight = straight / (straight + scattering);
        const bool is_straight = u[3] < go_straight;
        const float left = is_straight ? u[3] / go_straight : (u[3] - go_straight) / (1 - go_straight);
        std::optional<ScatterSample> drawn;
        if (is_straight) {
            flux_ *= shading.transparency / go_straight;
        } else {
            // As camera_path.h has it: at a sheet that encloses nothing flux is scaled in the place of radiance.
            const bool is_body = scene_.mesh_of(hit).is_closed;
            drawn = draw(hit, shading, lobes, {u[0], u[1], u[2]}, is_body ? Transport::flux : Transport::radiance);
            if (!drawn) return end(before, {});
            flux_ *= drawn->weight * (normal_correction(hit, ray_.direction, drawn->direction) / (1 - go_straight));
            if (state_.depth == tracing_.max_bounces) {
                add(traced_.balance.cut, flux_);
                return end(before, flux_);
            }
        }

        // Russian roulette by the ratio of the fluxes: surviving photons keep about the same.
        const float survival = std::min(1.0f, max_component(flux_) / max_component(before));
        add(traced_.balance.absorbed, before - flux_);
        if (!(left < survival) || state_.transparent_depth == max_transparent_depth) return false;
        flux_ = flux_ / survival;
        if (is_straight) {
            ray_.origin = hit.origin_towards(ray_.direction);
            state_ = passed(state_);
            return true;
        }
        was_diffuse_ = was_diffuse_ || (drawn->lobe & diffuse_lobes) != 0;
        state_ = scattered(state_, *drawn);
        source_visibility_ = scene_.instances[hit.instance].visibility;
        ray_ = {hit.origin_towards(drawn->direction), drawn->direction};
        return true;
    }

    /// Draws by diffuse or by glossy closures alone where that decides which map the photon is for: a direction that
    /// either may send it in would bring the light of both to one map.
    std::optional<ScatterSample> draw(const SurfacePoint &hit, const Shading &shading, Lobes lobes,
                                      std::array<float, 3> u, Transport transport) const {
        if (was_diffuse_) return draw_adjoint(hit, shading, lobes, u, transport);
        const float diffuse = average(albedo(shading, lobes & diffuse_lobes)) / average(albedo(shading, lobes));
        const bool is_diffuse = u[2] < diffuse;
        const float share = is_diffuse ? diffuse : 1 - diffuse;
        u[2] = std::min((is_diffuse ? u[2] : u[2] - diffuse) / share, 1 - std::numeric_limits<float>::epsilon() / 2);
        auto drawn = draw_adjoint(hit, shading, lobes & (is_diffuse ? diffuse_lobes : glossy_lobes), u, transport);
        if (drawn) drawn->weight = drawn->weight / share;
        return drawn;
    }

    /// Draws a direction as the closures have it, and weighs it as a path from the camera would that came from there:
    /// what is scattered from one direction to another may depend on which of them it is seen from, and a picture is
    /// what the camera sees (Veach 1997, section 5.3: the adjoint of a BSDF that is not symmetric).
    std::optional<ScatterSample> draw_adjoint(const SurfacePoint &hit, const Shading &shading, Lobes lobes,
                                              const std::array<float, 3> &u, Transport transport) const {
        auto drawn = sample(shading, lobes, u, transport);
        if (!drawn || hit.material->traits.is_reciprocal) return drawn;
        const Vec3 from = -ray_.direction, to = drawn->direction;
        const bool transmits = (drawn->lobe & transmissive_lobes) != 0;
        const SurfacePoint seen = transmits ? hit.turned() : hit;
        const float arriving = dot(from, hit.shading_normal), leaving = dot(to, seen.shading_normal);
        if (!(arriving > 0 && leaving > 0)) return drawn;  // before one surface and behind the other
        constexpr Vec3 bound{max_shading_ratio, max_shading_ratio, max_shading_ratio};  // lest one outshine all others
        if (drawn->is_singular) {
            // Of a boundary without roughness there is but the normal that is not the same.
            const float turned = std::abs(dot(from, drawn->normal) / dot(to, drawn->normal));
            drawn->weight = min(drawn->weight * (turned * leaving / arriving), bound);
            return drawn;
        }
        const Transport back = transport == Transport::flux ? Transport::radiance : Transport::flux;
        const Vec3 there = evaluate(shade(scene_, seen, to, state_), lobes, from, back);
        drawn->weight = min(there * (leaving / (arriving * drawn->pdf)), bound);
        return drawn;
    }

    bool end(Vec3 before, Vec3 after) {
        add(traced_.balance.absorbed, before - after);
        return false;
    }

    const Scene &scene_;
    const PhotonTracing &tracing_;
    Sequence &sequence_;
    TracedPhotons &traced_;
    Ray ray_;
    Vec3 flux_;
    RayState state_;
    uint32_t source_visibility_ = ~0u;  ///< of the light or object that sent the photon here: bits 1 << pm_ray
    bool was_diffuse_ = false;
    size_t source_ = 0;                ///< of Lights
    uint32_t number_ = 0, label_ = 0;  ///< as PhotonOrigin has them
    bool casts_shadow_ = false;        ///< a surface stopped the light; what lies behind is marked
};

std::optional<PhotonEmission> emit(const Emission &emission, PhotonPurpose purpose, Sequence &sequence) {
    return purpose == PhotonPurpose::caustic ? emission.emit_caustic(sequence) : emission.emit(sequence);
}

}  // namespace

void trace_photon(const Scene &scene, const Emission &emission, const PhotonTracing &tracing, uint64_t number,
                  TracedPhotons &traced) {
    Sequence sequence(tracing.first + number, tracing.seed);
    const std::optional<PhotonEmission> photon = emit(emission, tracing.purpose, sequence);
    if (!photon || !(max_component(photon->flux) > 0)) return;
    PhotonPath(scene, tracing, sequence, traced).trace(*photon, number);
}

}  // namespace photon_maps
