// SPDX-License-Identifier: GPL-3.0-or-later
// One path from the camera, and what it brings to its pixel.
//
// Each closure is diffuse (D) or glossy (S, specular however rough); what a surface scatters is the sum of both, so
// each path of light is exactly one word, and one row of this table carries it (Heckbert 1990; * any number, + at least
// one). R is an S that is a rough reflection by a surface that is diffuse, too, as are most things that are not metal
// or glass:
//
//   from light to eye       photon map                             path tracing
//   L E                     the ray meets the light                the same
//   L S* S E but for the    the path goes on until it meets the    the same
//     next row              light, and at its vertices samples
//                           the lights (multiple importance)
//   L S+ R S* E             caustic map, at the first R from       the path goes on
//                           the eye, where a path would meet a
//                           lamp's image in glass by rare chance
//   L D S* E                light sampling at D, and a ray from    the same, by the path's
//                           D that may meet an emissive mesh       next ray
//   L S+ D S* E             caustic map, at the first D from       the path goes on
//                           the eye
//   L (S|D)* D S* D S* E    global map, at the first D from the    the path goes on
//                           eye
//
// Where paths bring the light of diffuse bounces (Indirect::paths) the last row is theirs, as in path tracing, and the
// caustic map is asked at every D of the path; with Indirect::all_paths the caustic map's rows are theirs, too. So the
// map is in a final gather, until it ends and asks both maps for all. Without CameraPass::gathers_rough R is as any S.
//
// Where the eye looks into water or glass the path follows both reflection and refraction, up to its third scattering;
// elsewhere it goes on by one of its ways, drawn by what they bring.
//
// Straight passage through transparent surfaces is no scattering: shadow rays, photons and paths all pass.
//
// Refraction scales radiance, not flux, where a path enters or leaves a body. A sheet that encloses nothing stands for
// a pane or for the surface of water, and who looks through it must not see all darker by the square of its index:
// there radiance is left alone, and flux takes the factor. What lies under water has it once either way. A path that
// leaves a body without having entered it began there, and is scaled by nothing: the camera measures in its own medium.
#pragma once

#include "camera_pass.h"
#include "sequence.h"

namespace photon_maps {

/// Follows a ray of the camera.
/// @param is_probe whether PixelSample::global and caustic_map are asked for
/// @param counts is raised by the rays that were traced
/// @param levels may be null; else the caustic map is asked by nested radii, and what they bring is added here. The
/// sample has it by one of them
PixelSample trace_camera_path(const CameraPass &pass, const Ray &ray, bool is_probe, const Sequence &sequence,
                              RayCounts &counts, Levels *levels);

}  // namespace photon_maps
