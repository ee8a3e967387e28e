/** One solution on the page: puts stage, controls, panels, keys and address together. */
import { Vector3 } from 'three';
import { inspectNode, toJson, type LobeJson } from '../inspect/inspection';
import { Selection, type Seat } from '../inspect/selection';
import { boundsOf } from '../solution/bounds';
import type { Solution } from '../solution/solution';
import { formatAddress, parseAddress, type Address } from '../stage/address';
import { Controls } from '../stage/controls';
import { Flight } from '../stage/flight';
import { findKey, isOnCanvas, isTaken } from '../stage/keys';
import { defaultSettings, type Quantity, type Settings } from '../draw/settings';
import { Stage, type Pose } from '../stage/stage';
import { poseOfAll, poseOfCamera, poseOfPlace } from '../stage/views';
import { CamerasBar } from './cameras_bar';
import { download, region } from './dom';
import { screenshot } from './screenshot';
import { signed, stem } from './format';
import { fillHelp } from './help';
import { Inspector } from './inspector';
import { keyGroups } from './key_list';
import { Legend, scaleFor } from './legend';
import { say } from './notices';
import { automaticExposure, PicturePanel } from './picture_panel';
import { fillTools } from './tools';

/** Browsers mind more than a hundred changes of the address in half a minute; milliseconds. */
const kAddressPause = 350;

export class Page {
  readonly stage: Stage;
  private readonly selection: Selection;
  private readonly flight: Flight;
  private readonly controls: Controls;
  private readonly legend: Legend;
  private readonly picture: PicturePanel;
  private readonly inspector: Inspector;
  private readonly bar: CamerasBar;
  private readonly cameraPoses: Pose[];
  private readonly lMax: number;
  private readonly size: number;
  private readonly away = new AbortController();
  /** The named camera that the eye is at. */
  private camera: number | null = null;
  private pinned = false;
  private followed: object | null = null;
  private written = '';
  private writing = 0;

  constructor(readonly solution: Solution, openFile: () => void) {
    const canvas = region<HTMLCanvasElement>('canvas'), { signal } = this.away;
    this.stage = new Stage(canvas, solution);
    this.size = boundsOf(solution).getSize(new Vector3()).length();
    this.lMax = solution.patches.reduce((most, { lobes }) => Math.max(most, lobes?.lMax ?? 0), 0);
    this.cameraPoses = solution.cameras.map((camera) => poseOfCamera(solution, camera));
    this.selection = new Selection(this.stage, this.size);
    this.flight = new Flight(this.stage);
    this.controls = new Controls(this.stage, this.flight, {
      size: this.size, signal,
      onClick: (x, y, shift) => this.click(x, y, shift),
      onMode: (mode, speed) => this.bar.setMode(mode, speed),
    });

    const groups = keyGroups({
      camera: (i) => this.goToCamera(i), reset: () => this.reset(), focus: () => this.focus(), all: () => this.goToAll(),
      toggleMode: () => this.toggleMode(), pickMiddle: (shift) => this.pickMiddle(shift), pin: () => this.pin(),
      escape: () => this.escape(), exposure: (stops) => this.addExposure(stops), degree: (by) => this.addDegree(by),
      wireframe: () => this.stage.set({ wireframe: !this.stage.settings.wireframe }),
      backs: () => this.stage.set({ seeThroughBacks: !this.stage.settings.seeThroughBacks }),
      panel: () => this.togglePanel(), open: openFile, help: () => this.help(),
    });
    fillHelp(region<HTMLDialogElement>('keys'), groups);
    const panelButton = fillTools(region('tools'), {
      open: openFile, screenshot: () => void this.screenshot(), help: () => this.help(), panel: () => this.togglePanel(),
    });
    panelButton.setAttribute('aria-pressed', String(!region('chrome').classList.contains('bare')));
    this.picture = new PicturePanel(this.stage, (quantity) => this.show(quantity));
    this.inspector = new Inspector(this.stage, this.selection, this.lMax, {
      pin: () => this.pin(), focus: () => this.focus(), clear: (seat) => this.clear(seat),
    });
    region('panel').replaceChildren(this.picture.element, this.inspector.element);
    this.legend = new Legend(region('legend'), this.stage);
    this.bar = new CamerasBar(region('cameras'), solution, {
      camera: (i) => this.goToCamera(i), all: () => this.goToAll(), mode: (mode) => this.controls.setMode(mode),
    });
    this.bar.setMode('orbit', this.controls.speed);
    region('title').textContent = solution.title;
    region('title').title = solution.title;
    const count = (n: number) => n.toLocaleString('en').replaceAll(',', '\u202f');
    region('facts').textContent = `${count(solution.nodeCount)} nodes, ${count(solution.elementCount)} elements` +
      (solution.trust ? `; ${solution.trust}` : '');
    region('facts').classList.toggle('warning', solution.trust !== '');
    document.title = solution.title;
    document.body.classList.add('open');

    this.stage.onChange(() => this.follow());
    this.selection.onChange(() => this.writeSoon());
    window.addEventListener('keydown', (event) => {
      // Walking wants its letters first: E is up there, and more light elsewhere.
      const free = !isTaken(event) && (isOnCanvas(event) || !event.code.startsWith('Arrow'));
      if (free && this.controls.keyDown(event)) event.preventDefault();
      else {
        const key = findKey(groups, event);
        if (!key) return;
        event.preventDefault();
        key.run!(event);
      }
    }, { signal });
    window.addEventListener('hashchange', () => {
      if (location.hash !== this.written) this.obeyAll(location.hash);
    }, { signal });

    this.stage.set(this.asAlways());
    this.stage.setPose(this.cameraPoses[0] ?? poseOfAll(solution));
    this.obey(location.hash);
    this.follow();
  }

  /** Null: none. */
  select(node: number | null): void {
    if (!this.selection.take(0, node)) say(`There is no node ${node}`);
  }

  compare(node: number | null): void {
    if (!this.selection.take(1, node)) say(`There is no node ${node}`);
  }

  /** Of any node, at the degree that is shown. Throws RangeError if there is none. */
  figures(node: number): LobeJson {
    const said = inspectNode(this.solution, node, this.stage.settings.degree);
    if (!said) throw new RangeError(`there is no node ${node}`);
    return toJson(said);
  }

  /** Makes room for another solution: listeners go, and the canvas is a new one. */
  dispose(): void {
    this.away.abort();
    this.flight.stop();
    this.selection.dispose();
    clearTimeout(this.writing);
    this.stage.dispose();
    const { canvas } = this.stage;
    canvas.getContext('webgl2')?.getExtension('WEBGL_lose_context')?.loseContext();
    canvas.replaceWith(canvas.cloneNode());
    history.replaceState(null, '', location.pathname + location.search);
  }

  private follow(): void {
    // Settings are a new object whenever they change; most of the time only the eye moves.
    if (this.stage.settings !== this.followed) {
      this.followed = this.stage.settings;
      this.picture.followSettings();
      this.inspector.followSettings();
      this.legend.followSettings();
    }
    const now = this.stage.pose;
    const at = this.cameraPoses.findIndex((pose) =>
      pose.eye.distanceTo(now.eye) + pose.target.distanceTo(now.target) < 1e-4 * this.size && Math.abs(pose.fov - now.fov) < 0.01);
    this.camera = at < 0 ? null : at;
    this.bar.setCamera(this.camera);
    this.writeSoon();
  }

  // The address.

  private writeSoon(): void {
    if (this.writing) return;
    this.writing = window.setTimeout(() => {
      this.writing = 0;
      this.written = formatAddress({
        pose: this.flight.destination ?? this.stage.pose, settings: this.stage.settings,
        node: this.selection.node, compare: this.selection.compared, lMax: this.lMax,
      });
      history.replaceState(null, '', this.written);
    }, kAddressPause);
  }

  /** Of an address that somebody typed or pasted: what it leaves out is as always. */
  private obeyAll(hash: string): void {
    this.stage.set(this.asAlways());
    this.setPinned(false);
    this.selection.take(1, null);
    this.selection.take(0, null);
    this.obey(hash);
  }

  /** Without cameras the eye starts where it sees all, and rooms show their black backs there. */
  private asAlways(): Settings {
    const seeThroughBacks = this.cameraPoses.length === 0;
    return { ...defaultSettings, exposure: automaticExposure(this.solution), seeThroughBacks };
  }

  private obey(hash: string): void {
    const address = parseAddress(hash);
    const named = this.solution.cameras.findIndex((camera) => camera.name === address.camera);
    this.flight.stop();
    if (address.pose) this.stage.setPose(address.pose);
    else if (named >= 0) this.stage.setPose(this.cameraPoses[named]);
    this.stage.set(address.settings);
    if (address.show) this.show(address.show.quantity, address.show);
    const known = (node: number | undefined) => node !== undefined && node < this.solution.nodeCount;
    if (known(address.node)) {
      this.selection.take(0, address.node!);
      if (known(address.compare)) this.selection.take(1, address.compare!);
    }
  }

  // Where the eye is.

  private goToCamera(index: number): void {
    const pose = this.cameraPoses[index];
    if (!pose) return;
    this.flight.to(pose);
    say(`Camera ${this.solution.cameras[index].name}`);
  }

  private goToAll(): void {
    this.flight.to(poseOfAll(this.solution, this.stage.pose));
  }

  private reset(): void {
    if (this.cameraPoses[0]) this.goToCamera(0);
    else this.flight.to(poseOfAll(this.solution));
  }

  private focus(): void {
    const said = this.selection.of(0);
    if (!said) return this.goToAll();
    // Three lobes wide.
    this.flight.to(poseOfPlace(this.stage.pose, new Vector3(...said.position), 0.3 * this.size));
  }

  private toggleMode(): void {
    this.controls.setMode(this.controls.mode === 'orbit' ? 'walk' : 'orbit');
    say(this.controls.mode === 'walk' ? 'Walking: W A S D, Q and E' : 'Turning about what is seen');
  }

  // What is looked at.

  private click(x: number, y: number, shift: boolean): void {
    const pick = this.stage.pick(x, y);
    if (!pick) return say('Nothing with a lobe is there');
    const seat: Seat = (shift || this.pinned) && this.selection.node !== null ? 1 : 0;
    if (shift && seat === 1) this.setPinned(true);
    this.selection.take(seat, pick);
    const said = this.selection.of(seat);
    if (said) say(`Node ${said.node} on ${said.surface}`);
    this.inspector.reveal();
  }

  private pickMiddle(shift: boolean): void {
    const { clientWidth, clientHeight } = this.stage.canvas;
    this.click(clientWidth / 2, clientHeight / 2, shift);
  }

  private pin(): void {
    if (this.selection.node === null) return say('Choose a node first');
    this.setPinned(!this.pinned);
    if (this.pinned) say('Now choose the node to compare with');
  }

  private setPinned(pinned: boolean): void {
    this.pinned = pinned;
    this.inspector.setPinned(pinned);
  }

  private clear(seat: Seat): void {
    this.setPinned(false);
    this.selection.take(seat, null);
    if (this.selection.node === null) this.stage.canvas.focus({ preventScroll: true });
  }

  private escape(): void {
    if (this.pinned && this.selection.compared === null) this.setPinned(false);
    else if (this.selection.compared !== null) this.clear(1);
    else if (this.selection.node !== null) this.clear(0);
  }

  // How it is shown.

  private show(quantity: Quantity | null, scale?: Address['show']): void {
    const why = quantity && this.stage.whyNot(quantity);
    if (why) return say(why);
    this.stage.set({ falseColour: quantity === null ? null : scaleFor(this.stage, quantity, scale) });
  }

  private addExposure(stops: number): void {
    const exposure = Math.round((this.stage.settings.exposure + stops) * 100) / 100;
    this.stage.set({ exposure });
    say(`${signed(exposure, 2)} EV`);
  }

  private addDegree(by: number): void {
    if (this.lMax === 0) return;
    const degree = Math.min(this.lMax, Math.max(0, Math.min(this.lMax, this.stage.settings.degree) + by));
    this.stage.set({ degree });
    say(degree === this.lMax ? 'Whole lobes' : `Lobes at degree ${degree}`);
  }

  private togglePanel(): void {
    const bare = region('chrome').classList.toggle('bare');
    region('panel-toggle').setAttribute('aria-pressed', String(!bare));
  }

  private help(): void {
    region<HTMLDialogElement>('keys').showModal();
  }

  private async screenshot(): Promise<void> {
    const camera = this.camera === null ? null : stem(this.solution.cameras[this.camera].name);
    const parts = [stem(this.solution.title), camera, this.selection.node === null ? null : `node${this.selection.node}`];
    const name = `${parts.filter((part) => part !== null && part !== '').join('_')}.png`;
    try {
      download(name, await screenshot(this.stage));
      say(`Saved ${name}`);
    } catch (error) {
      say(`No picture: ${(error as Error).message}`);
    }
  }
}

