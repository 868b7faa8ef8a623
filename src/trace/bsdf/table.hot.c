/* trace/bsdf/table.hot.c: from a batch's kind to its kernel, one table an instruction set. */
#include "trace/bsdf/local.h"

static void eval(vlBsdfKind kind, uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo, vlBsdfDirections wi,
                 float *const value[4], float *pdf) {
  switch (kind) {
    case VL_BSDF_DIFFUSE: vl_bsdf_diffuse_eval(n, params, wo, wi, value, pdf); break;
    case VL_BSDF_CONDUCTOR: vl_bsdf_conductor_eval(n, params, wo, wi, value, pdf); break;
    case VL_BSDF_DIELECTRIC: vl_bsdf_dielectric_eval(n, params, wo, wi, value, pdf); break;
    case VL_BSDF_THIN_DIELECTRIC: vl_bsdf_thin_eval(n, params, wo, wi, value, pdf); break;
    case VL_BSDF_COATED_DIFFUSE: vl_bsdf_coat_eval(n, params, wo, wi, value, pdf); break;
    case VL_BSDF_PRINCIPLED: vl_bsdf_principled_eval(n, params, wo, wi, value, pdf); break;
    case VL_BSDF_DIFFUSE_TRANSMISSION: vl_bsdf_translucent_eval(n, params, wo, wi, value, pdf); break;
    case VL_BSDF_LAYERED: vl_bsdf_layered_eval(n, params, wo, wi, value, pdf); break;
    case VL_BSDF_HAIR: vl_bsdf_hair_eval(n, params, wo, wi, value, pdf); break;
    case VL_BSDF_MEASURED: vl_bsdf_measured_eval(n, params, wo, wi, value, pdf); break;
    case VL_BSDF_KINDS: break;
  }
}

#define VL_SAMPLE(name) name(n, params, wo, u_lobe, u, v, wi, weight, pdf, flags, eta_scale)
static void sample(vlBsdfKind kind, uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo, const float *u_lobe,
                   const float *u, const float *v, vlBsdfDirections wi, float *const weight[4], float *pdf,
                   uint32_t *flags, float *eta_scale) {
  switch (kind) {
    case VL_BSDF_DIFFUSE: VL_SAMPLE(vl_bsdf_diffuse_sample); break;
    case VL_BSDF_CONDUCTOR: VL_SAMPLE(vl_bsdf_conductor_sample); break;
    case VL_BSDF_DIELECTRIC: VL_SAMPLE(vl_bsdf_dielectric_sample); break;
    case VL_BSDF_THIN_DIELECTRIC: VL_SAMPLE(vl_bsdf_thin_sample); break;
    case VL_BSDF_COATED_DIFFUSE: VL_SAMPLE(vl_bsdf_coat_sample); break;
    case VL_BSDF_PRINCIPLED: VL_SAMPLE(vl_bsdf_principled_sample); break;
    case VL_BSDF_DIFFUSE_TRANSMISSION: VL_SAMPLE(vl_bsdf_translucent_sample); break;
    case VL_BSDF_LAYERED: VL_SAMPLE(vl_bsdf_layered_sample); break;
    case VL_BSDF_HAIR: VL_SAMPLE(vl_bsdf_hair_sample); break;
    case VL_BSDF_MEASURED: VL_SAMPLE(vl_bsdf_measured_sample); break;
    case VL_BSDF_KINDS: break;
  }
}

const vlBsdfKernels vl_bsdf_kernel_table = {eval, sample};
