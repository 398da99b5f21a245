"""The material of glTF 2.0, to render what was exported: a Lambert layer under one GGX lobe.

Plugin ``layered``: glTF 2.0, appendix B, with KHR_materials_specular. The diffuse part is (1 - F) of the base
colour, F the Schlick term of h.v times the strength; masking is Smith's with correlated heights.
"""

from __future__ import annotations

from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np

from ..render.skin_bsdf import SkinBSDF

_MIN_COS = 1e-4


def texture(values: np.ndarray) -> dict[str, Any]:
    """A bilinear texture of linear values (N,N) or (N,N,C), clamped at its border."""
    values = values[..., None] if values.ndim == 2 else values
    return {
        "type": "bitmap",
        "bitmap": mi.Bitmap(np.ascontiguousarray(values, dtype=np.float32)),
        "raw": True,
        "filter_type": "bilinear",
        "wrap_mode": "clamp",
    }


class LayeredBSDF(SkinBSDF):
    """``specular`` is the strength, ``reflectance`` that at normal incidence of strength 1; ``tangent_normal``
    holds codes 0 to 1 against ``tangent`` and ``tangent_sign``, ``perceptual_roughness`` the root of alpha."""

    def __init__(self, props: Any) -> None:
        SkinBSDF.__init__(self, props)
        self.reflectance = props["reflectance"]
        self.perceptual = props.get_unbounded_texture("perceptual_roughness")
        self.tangent_normal, self.tangent, self.tangent_sign = (
            props.get_unbounded_texture(name) for name in ("tangent_normal", "tangent", "tangent_sign")
        )

    def _tangent_normal(self, si: Any, active: Any) -> Any:
        code = mi.Vector3f(self.tangent_normal.eval_3(si, active)) * 2 - 1
        n = si.sh_frame.n
        t = dr.normalize(mi.Vector3f(self.tangent.eval_3(si, active)))
        b = self.tangent_sign.eval_1(si, active) * dr.cross(n, t)
        return mi.Normal3f(si.to_local(dr.normalize(code.x * t + code.y * b + code.z * n)))

    def _surface(self, si: Any, active: Any) -> Any:
        normal = self._tangent_normal(si, active)
        # The specification's floor is the renderer's own affair; ours keeps single precision sound.
        alpha = dr.clip(self.perceptual.eval_1(si, active) ** 2, 0.002, 1)
        specular = self.specular.eval_1(si, active) * self.reflectance
        lobes = ((alpha, mi.Float(1)), (alpha, mi.Float(0)))
        return self.diffuse.eval(si, active), specular, normal, mi.Frame3f(normal), si.to_local(si.n), lobes

    def _evaluate(self, ctx: Any, si: Any, wo: Any, active: Any, surface: Any) -> Any:
        rho, specular, normal, frame, n_g, lobes = surface
        active = active & (dr.dot(n_g, si.wi) > 0) & (dr.dot(n_g, wo) > 0)
        probability = self._specular_probability(ctx, si, surface)
        v, l = frame.to_local(si.wi), frame.to_local(wo)
        h = dr.normalize(v + l)
        value, pdf = mi.Color3f(0), mi.Float(0)
        fresnel = self._fresnel(specular, dr.dot(v, h))
        if ctx.is_enabled(mi.BSDFFlags.DiffuseReflection, 0):
            cosine = dr.fmax(dr.dot(normal, wo), 0) * dr.inv_pi
            value += rho * cosine * (1 - fresnel)
            pdf += (1 - probability) * cosine
        if ctx.is_enabled(mi.BSDFFlags.GlossyReflection, 1):
            ok = (v.z > _MIN_COS) & (l.z > _MIN_COS)
            alpha = lobes[0][0]
            lobe = mi.MicrofacetDistribution(mi.MicrofacetType.GGX, alpha, True)
            d = lobe.eval(h)
            a2 = alpha * alpha
            masked = l.z * dr.sqrt(a2 + (1 - a2) * v.z * v.z) + v.z * dr.sqrt(a2 + (1 - a2) * l.z * l.z)
            # D V cos with V = 1 / (2 masked), Heitz 2014.
            value += dr.select(ok, fresnel * d * l.z / (2 * dr.select(ok, masked, 1)), 0)
            pdf += dr.select(ok, probability * d * lobe.smith_g1(v, h) / (4 * v.z), 0)
        return dr.select(active, value, 0), dr.select(active, pdf, 0)

    def _fresnel(self, specular: Any, cosine: Any) -> Any:
        m = dr.clip(1 - cosine, 0, 1)
        return specular + (specular / self.reflectance - specular) * (m * m) * (m * m) * m

    def traverse(self, callback: Any) -> None:
        callback.put("diffuse", self.diffuse, mi.ParamFlags.Differentiable)

    def to_string(self) -> str:
        return "LayeredBSDF[]"


def register() -> None:
    """Makes the plugin known; the variant must be chosen."""
    mi.register_bsdf("layered", LayeredBSDF)
