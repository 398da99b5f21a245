export {
  BufferAttribute, BufferGeometry, Color, DataTexture, DepthTexture, FloatType, GLSL3, HalfFloatType, InterleavedBuffer,
  InterleavedBufferAttribute, LinearFilter, LinearMipmapLinearFilter, LinearSRGBColorSpace, Matrix4, Mesh, NearestFilter,
  NoBlending, NoColorSpace, OrthographicCamera, PerspectiveCamera, PlaneGeometry, Raycaster, RepeatWrapping, RGBAFormat,
  Scene, ShaderMaterial, Sphere, UnsignedByteType, Vector2, Vector3, Vector4, WebGLRenderer, WebGLRenderTarget,
} from "three";
export { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
export { EXRLoader } from "three/examples/jsm/loaders/EXRLoader.js";
export { HDRLoader } from "three/examples/jsm/loaders/HDRLoader.js";
