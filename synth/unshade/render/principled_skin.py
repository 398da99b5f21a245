"""Skin made of Mitsuba's `principled` (Burley 2012, 2015): a truth of another material than solvers assume.

    f(v, l) cos = rho_d B_d(n_d) + rho_s/F0 B_s(n_s)

B_d is the diffuse term of a white principled material, B_s the reflection of a black one with F0 = 0.04 (index
1.5): what Lambert and two lobes with Schlick's term are to `skin_bsdf`. There is one GGX lobe, as rough as the
mean of the two that a roughness map holds; the Fresnel term is that of a dielectric; the diffuse term is darker
or brighter than Lambert's near grazing, by the roughness. Maps, normals and sidedness are those of `skin_bsdf`.
"""

from __future__ import annotations

from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np

from .skin_bsdf import F0, LOBE_ALPHAS, LOBE_WEIGHTS, MIN_ALPHA, SkinBSDF


def principled_roughness(lobes: np.ndarray | None) -> np.ndarray:
    """Mitsuba's roughness (the root of GGX alpha) [N, N] for a roughness map [N, N, 3], or [1, 1] of standard skin."""
    if lobes is None:
        return np.full((1, 1), np.sqrt(np.dot(LOBE_ALPHAS, LOBE_WEIGHTS)), np.float32)
    share = lobes[..., 2].clip(0, 1)
    alpha = share * lobes[..., 0] + (1 - share) * lobes[..., 1]
    return np.sqrt(alpha.clip(MIN_ALPHA, 1)).astype(np.float32)


class PrincipledSkinBSDF(SkinBSDF):
    """Plugin ``principled_skin``: the textures of ``skin``, and ``principled_roughness`` (scalar, raw)."""

    def __init__(self, props: Any) -> None:
        super().__init__(props)
        roughness = props.get_unbounded_texture("principled_roughness")

        def plain(colour: float) -> Any:
            return mi.load_dict(
                {
                    "type": "principled",
                    "base_color": {"type": "rgb", "value": colour},
                    "roughness": roughness,
                    "specular": 0.5,
                }
            )

        self.white, self.black = plain(1.0), plain(0.0)

    @staticmethod
    def _turned(si: Any, n: Any) -> Any:
        """The interaction with the shading normal ``n``, given in its own frame."""
        turned = mi.SurfaceInteraction3f(si)
        turned.sh_frame = mi.Frame3f(dr.normalize(si.to_world(n)))
        turned.wi = turned.to_local(si.to_world(si.wi))
        return turned

    def _evaluate(self, ctx, si, wo, active, surface):
        rho_d, rho_s, n_d, frame, n_g, _ = surface
        active = active & (dr.dot(n_g, si.wi) > 0) & (dr.dot(n_g, wo) > 0)
        probability = self._specular_probability(ctx, si, surface)
        world, all_ = si.to_world(wo), mi.BSDFContext()
        value, pdf = mi.Color3f(0), mi.Float(0)
        if ctx.is_enabled(mi.BSDFFlags.DiffuseReflection, 0):
            soft = self._turned(si, n_d)
            local = soft.to_local(world)
            white = self.white.eval(all_, soft, local, active) - self.black.eval(all_, soft, local, active)
            value += rho_d * dr.fmax(white, 0)
            pdf += (1 - probability) * dr.fmax(dr.dot(n_d, wo), 0) * dr.inv_pi
        if ctx.is_enabled(mi.BSDFFlags.GlossyReflection, 1):
            sharp = self._turned(si, frame.n)
            reflected, sampled = self.black.eval_pdf(all_, sharp, sharp.to_local(world), active)
            value += rho_s / F0 * reflected
            pdf += probability * sampled
        return dr.select(active, value, 0), dr.select(active, pdf, 0)

    def _sample(self, ctx, si, sample1, sample2, active, surface):
        _, _, n_d, frame, _, _ = surface
        probability = self._specular_probability(ctx, si, surface)
        specular = sample1 < probability
        sharp = self._turned(si, frame.n)
        # The rest of the first random number picks the lobe of the black material.
        rest = dr.clip(sample1 / dr.select(probability > 0, probability, 1), 0, 1)
        reflection, _ = self.black.sample(mi.BSDFContext(), sharp, rest, sample2, active & specular)
        diffuse_wo = mi.Frame3f(n_d).to_world(mi.warp.square_to_cosine_hemisphere(sample2))
        bs = dr.zeros(mi.BSDFSample3f)
        bs.wo = dr.select(specular, si.to_local(sharp.to_world(reflection.wo)), diffuse_wo)
        bs.eta = 1.0
        bs.sampled_type = dr.select(
            specular, mi.UInt32(+mi.BSDFFlags.GlossyReflection), mi.UInt32(+mi.BSDFFlags.DiffuseReflection)
        )
        bs.sampled_component = dr.select(specular, mi.UInt32(1), mi.UInt32(0))
        value, bs.pdf = self._evaluate(ctx, si, bs.wo, active, surface)
        ok = active & (bs.pdf > 0) & dr.select(specular, reflection.pdf > 0, True)
        return bs, dr.select(ok, value / dr.select(ok, bs.pdf, 1), 0)

    def to_string(self):
        return "PrincipledSkinBSDF[]"
