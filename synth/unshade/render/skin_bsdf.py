"""The skin material, one for truth and relighting, chart and rest of the head.

    f(v, l) cos = rho_d/pi max(n_d.l, 0)
                + rho_s/F0 sum_k w_k D_k(h) G1_k(v) G1_k(l) / (4 n_s.v) F(h.v)

Lambert on the diffuse normal, two GGX lobes with Schlick's Fresnel term on the specular
normal. rho_s reads as reflectance at normal incidence (0 to 0.05): the paper's product of
a specular albedo and a Fresnel term with F0 = 0.04.

The lobes have the standard roughness, one of their own, or one that varies over the skin.
Normals come from textures in object space, which is world space here, and go through the
interaction's frame; so no tangent frame, and thus no tessellation, enters the material.
Without a texture, or where a texel holds no direction, the interpolated mesh normal serves.
"""

from __future__ import annotations

import drjit as dr
import mitsuba as mi

F0 = 0.04
"""Reflectance of skin at normal incidence, for which rho_s = F0 is the plain Fresnel term."""

LOBE_ALPHAS = (0.15, 0.35)
"""Standard skin roughness: GGX alphas of the two lobes."""

LOBE_WEIGHTS = (0.5, 0.5)
"""Shares of the two lobes, equal as in the shaders of Digital Emily 2."""

MIN_ALPHA = 0.02
"""Lobes of a roughness map are at least this rough: sharper than any skin or tear film, and
wide enough that half vectors in single precision resolve them."""

_MIN_COS = 1e-4
_SPECULAR_PROBABILITY = (0.15, 0.85)
"""Bounds of the probability to sample the specular lobes, so that neither part starves."""


def schlick(cosine):
    """Schlick's Fresnel term with F0 = 0.04."""
    m = dr.clip(1 - cosine, 0, 1)
    m2 = m * m
    return F0 + (1 - F0) * (m2 * m2 * m)


def _safe_ratio(numerator, denominator):
    return numerator / dr.select(denominator > 0, denominator, 1)


class SkinBSDF(mi.BSDF):
    """Plugin ``skin``: textures ``diffuse`` (RGB) and ``specular`` (scalar), optional
    textures ``diffuse_normal`` and ``specular_normal`` (xyz, object space, raw), optional
    texture ``roughness`` (GGX alpha of lobe 1, of lobe 2, share of lobe 1; raw) or optional
    ``alpha`` (both lobes get this roughness: the wet eye)."""

    def __init__(self, props):
        mi.BSDF.__init__(self, props)
        self.diffuse = props.get_unbounded_texture("diffuse")
        self.specular = props.get_unbounded_texture("specular")
        self.diffuse_normal, self.specular_normal, self.roughness = (
            props.get_unbounded_texture(name) if name in props else None
            for name in ("diffuse_normal", "specular_normal", "roughness")
        )
        alpha = props.get("alpha", 0.0)
        self.lobes = tuple(zip((alpha, alpha) if alpha > 0 else LOBE_ALPHAS, LOBE_WEIGHTS))
        varying = mi.BSDFFlags.FrontSide | mi.BSDFFlags.SpatiallyVarying
        self.m_components = [
            mi.BSDFFlags.DiffuseReflection | varying,
            mi.BSDFFlags.GlossyReflection | varying,
        ]
        self.m_flags = self.m_components[0] | self.m_components[1]

    def _normal(self, texture, si, active):
        if texture is None:
            return mi.Normal3f(0, 0, 1)
        n = si.to_local(mi.Vector3f(texture.eval_3(si, active)))
        length2 = dr.squared_norm(n)
        known = length2 > 1e-8
        n *= dr.rsqrt(dr.select(known, length2, 1))
        return mi.Normal3f(dr.select(known, n, mi.Vector3f(0, 0, 1)))

    def _lobes(self, si, active):
        """GGX alpha and weight of both lobes."""
        if self.roughness is None:
            return self.lobes
        first, second, weight = mi.Vector3f(self.roughness.eval_3(si, active))
        weight = dr.clip(weight, 0, 1)
        return (dr.clip(first, MIN_ALPHA, 1), weight), (dr.clip(second, MIN_ALPHA, 1), 1 - weight)

    def _surface(self, si, active):
        """Colours, specular reflectance, diffuse normal, specular frame, geometric normal, lobes."""
        return (
            self.diffuse.eval(si, active),
            self.specular.eval_1(si, active),
            self._normal(self.diffuse_normal, si, active),
            mi.Frame3f(self._normal(self.specular_normal, si, active)),
            si.to_local(si.n),
            self._lobes(si, active),
        )

    def _specular_probability(self, ctx, si, surface):
        """Probability to sample the specular lobes; 0 where they are out of sight."""
        rho_d, rho_s, _, frame, _, _ = surface
        if not ctx.is_enabled(mi.BSDFFlags.GlossyReflection, 1):
            return mi.Float(0)
        seen = dr.dot(frame.n, si.wi) > _MIN_COS
        if not ctx.is_enabled(mi.BSDFFlags.DiffuseReflection, 0):
            return dr.select(seen, mi.Float(1), mi.Float(0))
        strength = rho_s / F0 * schlick(dr.dot(frame.n, si.wi))
        probability = strength / (strength + mi.luminance(rho_d) + 1e-6)
        return dr.select(seen & (rho_s > 0), dr.clip(probability, *_SPECULAR_PROBABILITY), 0)

    def _evaluate(self, ctx, si, wo, active, surface):
        rho_d, rho_s, n_d, frame, n_g, lobes = surface
        # Sidedness is judged by the triangle, not the interpolated normal, which leans
        # away from the eye at silhouettes and would leave black pixels there.
        active = active & (dr.dot(n_g, si.wi) > 0) & (dr.dot(n_g, wo) > 0)
        probability = self._specular_probability(ctx, si, surface)
        value, pdf = mi.Color3f(0), mi.Float(0)
        if ctx.is_enabled(mi.BSDFFlags.DiffuseReflection, 0):
            cosine = dr.fmax(dr.dot(n_d, wo), 0) * dr.inv_pi
            value += rho_d * cosine
            pdf += (1 - probability) * cosine
        if ctx.is_enabled(mi.BSDFFlags.GlossyReflection, 1):
            v, l = frame.to_local(si.wi), frame.to_local(wo)
            ok = (v.z > _MIN_COS) & (l.z > 0)
            h = dr.normalize(v + l)
            sampled, reflected = mi.Float(0), mi.Float(0)
            for alpha, weight in lobes:
                lobe = mi.MicrofacetDistribution(mi.MicrofacetType.GGX, alpha, True)
                # Density of visible normals times 1/(4 h.l); the lobe's value is the same
                # but for the masking of the outgoing direction.
                density = weight * lobe.eval(h) * lobe.smith_g1(v, h) / (4 * v.z)
                sampled += density
                reflected += density * lobe.smith_g1(l, h)
            value += dr.select(ok, reflected * (rho_s / F0) * schlick(dr.dot(v, h)), 0)
            pdf += dr.select(ok, probability * sampled, 0)
        return dr.select(active, value, 0), dr.select(active, pdf, 0)

    def _sample(self, ctx, si, sample1, sample2, active, surface):
        _, _, n_d, frame, _, ((alpha_1, weight_1), (alpha_2, _)) = surface
        probability = self._specular_probability(ctx, si, surface)
        specular = sample1 < probability
        # The rest of the first random number picks the lobe.
        first = _safe_ratio(sample1, probability) < weight_1
        alpha = dr.select(first, mi.Float(alpha_1), mi.Float(alpha_2))
        lobe = mi.MicrofacetDistribution(mi.MicrofacetType.GGX, alpha, True)
        v = frame.to_local(si.wi)
        h, _ = lobe.sample(v, sample2)
        l = mi.reflect(v, h)
        diffuse_wo = mi.Frame3f(n_d).to_world(mi.warp.square_to_cosine_hemisphere(sample2))
        bs = dr.zeros(mi.BSDFSample3f)
        bs.wo = dr.select(specular, frame.to_world(l), diffuse_wo)
        bs.eta = 1.0
        bs.sampled_type = dr.select(
            specular,
            mi.UInt32(+mi.BSDFFlags.GlossyReflection),
            mi.UInt32(+mi.BSDFFlags.DiffuseReflection),
        )
        bs.sampled_component = dr.select(specular, mi.UInt32(1), mi.UInt32(0))
        value, bs.pdf = self._evaluate(ctx, si, bs.wo, active, surface)
        # A specular sample below the specular horizon may still lie above the diffuse one,
        # where the density of the diffuse part is not what produced it.
        ok = active & (bs.pdf > 0) & dr.select(specular, (v.z > _MIN_COS) & (l.z > 0), True)
        if not ctx.is_enabled(mi.BSDFFlags.DiffuseReflection, 0):
            ok &= specular
        return bs, dr.select(ok, value / dr.select(ok, bs.pdf, 1), 0)

    def sample(self, ctx, si, sample1, sample2, active=True):
        return self._sample(ctx, si, sample1, sample2, active, self._surface(si, active))

    def eval(self, ctx, si, wo, active=True):
        return self._evaluate(ctx, si, wo, active, self._surface(si, active))[0]

    def pdf(self, ctx, si, wo, active=True):
        return self._evaluate(ctx, si, wo, active, self._surface(si, active))[1]

    def eval_pdf(self, ctx, si, wo, active=True):
        return self._evaluate(ctx, si, wo, active, self._surface(si, active))

    def eval_pdf_sample(self, ctx, si, wo, sample1, sample2, active=True):
        surface = self._surface(si, active)
        return (
            *self._evaluate(ctx, si, wo, active, surface),
            *self._sample(ctx, si, sample1, sample2, active, surface),
        )

    def eval_diffuse_reflectance(self, si, active=True):
        return self.diffuse.eval(si, active)

    def traverse(self, callback):
        for name in ("diffuse", "specular", "diffuse_normal", "specular_normal", "roughness"):
            texture = getattr(self, name)
            if texture is not None:
                callback.put(name, texture, mi.ParamFlags.Differentiable)

    def to_string(self):
        return "SkinBSDF[]"
