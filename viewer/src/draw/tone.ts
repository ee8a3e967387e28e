import { GLSL3, NoBlending, RawShaderMaterial, Vector2, type Texture, type WebGLRenderer } from 'three';
import { kLuminance } from '../solution/luminance';
import { toneCurves, type Settings } from './settings';
import { colourTexture, falseColourGlsl } from './colour_map';
import { FullScreen, fullScreenVertex } from './full_screen';
import { curveGlsl } from './tone_curves';

/** Exact sRGB (IEC 61966-2-1), to and from. */
export const srgbGlsl = /* glsl */ `
vec3 encodeSrgb(vec3 v) {
  return mix(1.055 * pow(v, vec3(1.0 / 2.4)) - 0.055, 12.92 * v, lessThanEqual(v, vec3(0.0031308)));
}
vec3 decodeSrgb(vec3 v) {
  return mix(pow((v + 0.055) / 1.055, vec3(2.4)), v / 12.92, lessThanEqual(v, vec3(0.04045)));
}
`;

/** What the picture's texture holds: light, light to be shown in false colours, or colours of the display. */
export type Content = 'light' | 'radiance' | 'colours';

/** From scene-linear light to the screen: exposure, curve, sRGB, 8 bits rounded to the nearest. */
export class Tone {
  private readonly pass: FullScreen;
  private readonly colours = colourTexture(null);

  constructor(/** Of the texture: its numbers are radiance times this. */ private readonly unit: number) {
    this.pass = new FullScreen(new RawShaderMaterial({
      glslVersion: GLSL3,
      depthTest: false,
      depthWrite: false,
      blending: NoBlending,
      uniforms: {
        picture: { value: null }, size: { value: new Vector2() }, gain: { value: 1 }, curve: { value: 0 }, content: { value: 0 },
        colours: { value: this.colours }, scale: { value: new Vector2(0, 1) }, logarithmic: { value: false },
        kinds: { value: 0 },
      },
      vertexShader: fullScreenVertex,
      fragmentShader: /* glsl */ `
        precision highp float;
        uniform highp sampler2D picture;
        uniform vec2 size;
        uniform float gain;
        uniform int content;
        out vec4 shown;
        ${falseColourGlsl} ${srgbGlsl} ${curveGlsl}
        void main() {
          vec4 pixel = texture(picture, gl_FragCoord.xy / size);
          vec3 display;
          if (content == 0) display = encodeSrgb(curved(max(pixel.rgb, 0.0) * gain));
          else if (content == 1) display = pixel.a * falseColour(dot(pixel.rgb, vec3(${kLuminance})) * gain);
          else display = encodeSrgb(clamp(pixel.rgb, 0.0, 1.0));
          shown = vec4(floor(display * 255.0 + 0.5) / 255.0, 1.0);
        }`,
    }));
  }

  draw(renderer: WebGLRenderer, picture: Texture, content: Content, settings: Readonly<Settings>, size: Vector2): void {
    const u = this.pass.material.uniforms;
    u.picture.value = picture;
    (u.size.value as Vector2).copy(size);
    u.content.value = ['light', 'radiance', 'colours'].indexOf(content);
    u.curve.value = toneCurves.indexOf(settings.curve);
    // False colours have their own scale, which exposure must not shift.
    u.gain.value = (content === 'light' ? 2 ** settings.exposure : 1) / this.unit;
    if (settings.falseColour) {
      (u.scale.value as Vector2).set(settings.falseColour.low, settings.falseColour.high);
      u.logarithmic.value = settings.falseColour.logarithmic;
    }
    this.pass.draw(renderer);
  }
}
