// One canvas that shows a surface or a map in the plane, and can be turned, moved and picked from.
import { Camera, Geometry, Mesh, Program, Renderer, Transform, Vec2, Vec3, type OGLRenderingContext } from 'ogl';
import { axes, moved, START, turned, zoomed, type Pose } from './camera';
import { coneColour, type Colour } from './colours';
import type { Drawing } from './model';
import { firstHit, type Ray } from './picking';
import * as shaders from './shaders';

/** What is drawn over a surface. */
export type MarkName = 'seams' | 'boundary' | 'features' | 'dropped' | 'cones';

/** How a surface is painted. */
export interface Paint {
    /** A colour for each corner of the triangles, three bytes. */
    readonly tints: Uint8Array;
    readonly pattern: 'none' | 'checks' | 'grid';
    /** Side of a check, in units of the map. */
    readonly period: number;
    readonly edges: boolean;
    readonly marks: ReadonlySet<MarkName>;
}

export interface ViewEvents {
    /** The pointer is over a face, or over none: -1. */
    hover(face: number): void;
    /** A face is picked at a point, or none: -1. */
    pick(face: number, point?: readonly number[]): void;
    move(pose: Pose): void;
}

const FIELD = 30;
/** Distance at which all of a sphere of radius 1 is seen. */
const DISTANCE = 1.02 / Math.sin((FIELD * Math.PI) / 360);
const LINES: readonly { name: MarkName; width: number; tint: Colour }[] = [
    { name: 'boundary', width: 1.6, tint: [70, 74, 84] },
    { name: 'seams', width: 1.7, tint: [170, 51, 119] },
    { name: 'features', width: 2.4, tint: [16, 18, 24] },
    { name: 'dropped', width: 2.8, tint: [213, 64, 0] },
];
/** Features that are being picked stand out from edges. */
const CHOSEN = { width: 3.6, tint: [0, 140, 125] as Colour };
const ACCENT = new Vec3(0.09, 0.62, 0.56);
const PATTERNS = { none: 0, checks: 1, grid: 2 };
/** Pixels that a pointer may move in a click. */
const CLICK = 4;

const bytes = ([r, g, b]: Colour): Vec3 => new Vec3(r / 255, g / 255, b / 255);

/** Whether this browser can draw. */
export function canDraw(): boolean {
    return document.createElement('canvas').getContext('webgl2') !== null;
}

export class View {
    pose: Pose = START;
    private readonly renderer: Renderer;
    private readonly gl: OGLRenderingContext;
    private readonly camera: Camera;
    private readonly root = new Transform();
    private readonly surface: Mesh;
    private readonly marks = new Map<MarkName, Mesh>();
    private readonly uniforms = {
        pattern: { value: 0 }, period: { value: 1 }, edges: { value: 0 }, hovered: { value: -1 }, picked: { value: -1 },
    };
    private readonly size = { value: new Vec2(1, 1) };
    private readonly pointers = new Map<number, { x: number; y: number }>();
    private pressed: { x: number; y: number } | undefined;
    private isDue = false;
    private hoverAt: { x: number; y: number } | undefined;

    constructor(
        readonly canvas: HTMLCanvasElement,
        private readonly drawing: Drawing,
        uvs: Float32Array,
        private readonly halves: number,
        private readonly events: ViewEvents,
    ) {
        this.renderer = new Renderer({
            canvas, dpr: Math.min(devicePixelRatio, 2), alpha: true, premultipliedAlpha: true, antialias: true,
            preserveDrawingBuffer: true,
        });
        this.gl = this.renderer.gl;
        this.camera = new Camera(this.gl, { fov: FIELD });
        this.surface = this.makeSurface(uvs);
        this.surface.setParent(this.root);
        for (const line of LINES) this.addMark(line.name, this.makeLines(drawing.marks[line.name as 'seams'], line));
        this.addMark('cones', this.makeCones());
        this.listen();
        const parent = canvas.parentElement ?? document.body;
        new ResizeObserver(() => { this.resize(parent); }).observe(parent);
        this.resize(parent);
    }

    /** Draws soon. */
    request(): void {
        if (this.isDue) return;
        this.isDue = true;
        requestAnimationFrame(() => {
            this.isDue = false;
            this.findHovered();
            this.draw();
        });
    }

    /** Draws at once, and says how many milliseconds that took. */
    measure(): number {
        const start = performance.now();
        this.draw();
        // Reading a pixel waits for the drawing.
        this.gl.readPixels(0, 0, 1, 1, this.gl.RGBA, this.gl.UNSIGNED_BYTE, new Uint8Array(4));
        return performance.now() - start;
    }

    paint(paint: Paint): void {
        this.uniforms.pattern.value = PATTERNS[paint.pattern];
        this.uniforms.period.value = paint.period;
        this.uniforms.edges.value = paint.edges ? 0.65 : 0;
        const { tint } = this.surface.geometry.attributes;
        if (tint.data !== paint.tints) {
            tint.data = paint.tints;
            tint.needsUpdate = true;
        }
        for (const [name, mesh] of this.marks) mesh.visible = paint.marks.has(name);
        this.request();
    }

    /** Shows which face is hovered and which is picked; -1 for none. */
    highlight(hovered: number, picked: number): void {
        this.uniforms.hovered.value = hovered;
        this.uniforms.picked.value = picked;
        this.request();
    }

    /** Draws other lines in the place of feature edges. */
    setFeatures(ends: Float32Array): void {
        this.marks.get('features')?.setParent(null);
        this.marks.delete('features');
        this.addMark('features', this.makeLines(ends, { name: 'features', ...CHOSEN }));
        this.request();
    }

    /** Frees what it draws with: a browser keeps few of them. */
    end(): void {
        this.gl.getExtension('WEBGL_lose_context')?.loseContext();
    }

    setPose(pose: Pose): void {
        this.pose = pose;
        this.request();
    }

    /** Brings a point of the drawing to the middle, close enough to see what is there. */
    goTo(point: readonly number[], extent: number): void {
        const { centre, radius, isFlat } = this.drawing;
        const middle = point.map((x, k) => (x - centre[k]) / radius) as [number, number, number];
        const zoom = Math.max(1, Math.min(40, (0.2 * radius) / (extent || radius)));
        const [x, y, z] = middle;
        const facing = isFlat || Math.hypot(x, y, z) < 1e-3 ? {} : { yaw: Math.atan2(x, z), pitch: Math.asin(y / Math.hypot(x, y, z)) * 0.7 };
        this.move({ ...this.pose, ...facing, zoom, middle });
    }

    /** The face under a point of the window, or -1. */
    faceAt(x: number, y: number): number {
        const hit = firstHit(this.drawing.triangles, this.ray(x, y));
        return hit ? Math.floor(hit.triangle / this.halves) : -1;
    }

    private move(pose: Pose): void {
        this.setPose(pose);
        this.events.move(pose);
    }

    private get flatPose(): Pose {
        return this.drawing.isFlat ? { ...this.pose, yaw: 0, pitch: 0 } : this.pose;
    }

    private draw(): void {
        const { centre, radius, isFlat } = this.drawing;
        const pose = this.flatPose;
        const [, , towards] = axes(pose);
        const target = centre.map((x, k) => x + radius * pose.middle[k]);
        const { width, height } = this.gl.canvas;
        const aspect = width / height || 1;
        const distance = isFlat ? 2 * radius : (DISTANCE * radius * Math.max(1, 1 / aspect)) / pose.zoom;
        this.camera.position.set(...(target.map((x, k) => x + distance * towards[k]) as [number, number, number]));
        this.camera.lookAt(new Vec3(...target));
        if (isFlat) {
            const half = this.halfHeight(aspect);
            this.camera.orthographic({ left: -half * aspect, right: half * aspect, bottom: -half, top: half, near: 0.01 * radius, far: 10 * radius });
        } else {
            const near = Math.max(distance - 4.5 * radius, distance * 0.02);
            this.camera.perspective({ aspect, near, far: distance + 4.5 * radius });
        }
        this.renderer.render({ scene: this.root, camera: this.camera, frustumCull: false, sort: false });
    }

    /** Half the height of the window on the plane. */
    private halfHeight(aspect: number): number {
        const [width, height] = this.drawing.extents;
        return (1.06 * (Math.max(height, width / aspect) || this.drawing.radius)) / this.pose.zoom;
    }

    private ray(x: number, y: number): Ray {
        const box = this.canvas.getBoundingClientRect();
        const [nx, ny] = [(2 * (x - box.left)) / box.width - 1, 1 - (2 * (y - box.top)) / box.height];
        const aspect = box.width / box.height;
        const { isFlat } = this.drawing;
        const [right, up, towards] = axes(this.flatPose);
        const eye = [...this.camera.position];
        if (isFlat) {
            const half = this.halfHeight(aspect);
            const origin = eye.map((e, k) => e + half * (nx * aspect * right[k] + ny * up[k]));
            return { origin, direction: towards.map((t) => -t) };
        }
        const half = Math.tan((FIELD * Math.PI) / 360);
        const direction = towards.map((t, k) => half * (nx * aspect * right[k] + ny * up[k]) - t);
        return { origin: eye, direction };
    }

    private makeSurface(uvs: Float32Array): Mesh {
        const { triangles, normals, isFlat } = this.drawing;
        const tint = { size: 3, data: new Uint8Array(triangles.length).fill(200), type: this.gl.UNSIGNED_BYTE, normalized: true };
        const geometry = new Geometry(this.gl, {
            position: { size: 3, data: triangles },
            normal: { size: 3, data: normals },
            uv: { size: 2, data: uvs },
            tint,
        });
        const program = new Program(this.gl, {
            vertex: shaders.SURFACE_VERTEX,
            fragment: shaders.SURFACE_FRAGMENT,
            cullFace: false,
            uniforms: {
                ...this.uniforms, halves: { value: this.halves }, accent: { value: ACCENT }, flat_light: { value: isFlat ? 1 : 0 },
            },
        });
        return new Mesh(this.gl, { geometry, program, frustumCulled: false });
    }

    private addMark(name: MarkName, mesh: Mesh | undefined): void {
        if (!mesh) return;
        mesh.setParent(this.root);
        this.marks.set(name, mesh);
    }

    private makeLines(ends: Float32Array, { name, width, tint }: (typeof LINES)[number]): Mesh | undefined {
        if (ends.length === 0) return undefined;
        const [start, end] = [new Float32Array(ends.length / 2), new Float32Array(ends.length / 2)];
        for (let k = 0; k < ends.length / 6; k++) {
            start.set(ends.subarray(6 * k, 6 * k + 3), 3 * k);
            end.set(ends.subarray(6 * k + 3, 6 * k + 6), 3 * k);
        }
        const lift = name === 'dropped' ? 4e-4 : 2.5e-4;
        return this.makeInstances(
            { start: { instanced: 1, size: 3, data: start }, end: { instanced: 1, size: 3, data: end } },
            shaders.LINE_VERTEX, shaders.LINE_FRAGMENT, width, lift, bytes(tint),
        );
    }

    private makeCones(): Mesh | undefined {
        const { cones, coneIndices } = this.drawing.marks;
        if (cones.length === 0) return undefined;
        const tints = new Float32Array(cones.length);
        coneIndices.forEach((index, k) => { tints.set([...bytes(coneColour(index))], 3 * k); });
        return this.makeInstances(
            { at: { instanced: 1, size: 3, data: cones }, tint: { instanced: 1, size: 3, data: tints } },
            shaders.POINT_VERTEX, shaders.POINT_FRAGMENT, cones.length > 900 ? 4.5 : 6.5, 2e-3, new Vec3(),
        );
    }

    private makeInstances(
        instances: Record<string, { instanced: number; size: number; data: Float32Array }>,
        vertex: string, fragment: string, width: number, lift: number, tint: Vec3,
    ): Mesh {
        const square = new Float32Array([-1, -1, 1, -1, 1, 1, -1, -1, 1, 1, -1, 1]);
        const geometry = new Geometry(this.gl, { position: { size: 2, data: square }, ...instances });
        const program = new Program(this.gl, {
            vertex, fragment, cullFace: false,
            uniforms: {
                size: this.size, width: { value: width * this.renderer.dpr }, tint: { value: tint },
                lift: { value: this.drawing.isFlat ? lift * 100 : lift },
            },
        });
        return new Mesh(this.gl, { geometry, program, frustumCulled: false });
    }

    private resize(parent: HTMLElement): void {
        this.renderer.setSize(parent.clientWidth, parent.clientHeight);
        this.size.value.set(this.gl.canvas.width, this.gl.canvas.height);
        this.request();
    }

    private listen(): void {
        const { canvas } = this;
        canvas.addEventListener('pointerdown', (event) => {
            canvas.setPointerCapture(event.pointerId);
            this.pointers.set(event.pointerId, event);
            this.pressed = this.pointers.size === 1 ? event : undefined;
        });
        canvas.addEventListener('pointermove', (event) => { this.drag(event); });
        const release = (event: PointerEvent): void => {
            this.pointers.delete(event.pointerId);
            if (event.type === 'pointerup' && this.pressed && isNear(this.pressed, event)) {
                const hit = firstHit(this.drawing.triangles, this.ray(event.clientX, event.clientY));
                this.events.pick(hit ? Math.floor(hit.triangle / this.halves) : -1, hit?.point);
            }
            this.pressed = undefined;
        };
        canvas.addEventListener('pointerup', release);
        canvas.addEventListener('pointercancel', release);
        canvas.addEventListener('pointerleave', () => { this.events.hover(-1); });
        canvas.addEventListener('contextmenu', (event) => { event.preventDefault(); });
        canvas.addEventListener('dblclick', () => { this.fit(); });
        canvas.addEventListener('wheel', (event) => {
            event.preventDefault();
            this.move(zoomed(this.pose, Math.exp(-event.deltaY * (event.deltaMode === 1 ? 0.04 : 0.0015))));
        }, { passive: false });
        canvas.addEventListener('keydown', (event) => { if (this.key(event)) event.preventDefault(); });
        canvas.addEventListener('webglcontextlost', (event) => { event.preventDefault(); });
    }

    /** All of the drawing, from where it is seen now. */
    fit(): void {
        this.move({ ...this.pose, zoom: 1, middle: [0, 0, 0] });
    }

    private drag(event: PointerEvent): void {
        const before = this.pointers.get(event.pointerId);
        if (!before) {
            this.hoverAt = { x: event.clientX, y: event.clientY };
            this.request();
            return;
        }
        const { clientWidth, clientHeight } = this.canvas;
        const scale = 2 / Math.min(clientWidth, clientHeight);
        const [dx, dy] = [event.clientX - xOf(before), event.clientY - yOf(before)];
        const others = [...this.pointers].filter(([id]) => id !== event.pointerId);
        this.pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
        if (this.pressed && isNear(this.pressed, event)) return;
        this.pressed = undefined;
        if (others.length > 0) {
            const [, other] = others[0];
            const gap = (x: number, y: number): number => Math.hypot(x - xOf(other), y - yOf(other)) || 1;
            const factor = gap(event.clientX, event.clientY) / gap(xOf(before), yOf(before));
            this.move(moved(zoomed(this.pose, factor), (-dx * scale) / 2, (dy * scale) / 2));
        } else if (this.drawing.isFlat || event.buttons > 1 || event.shiftKey) {
            const pose = moved(this.flatPose, -dx * scale, dy * scale);
            this.move({ ...this.pose, middle: pose.middle });
        } else {
            this.move(turned(this.pose, -dx * scale * 1.6, dy * scale * 1.6));
        }
    }

    private findHovered(): void {
        if (!this.hoverAt) return;
        const { x, y } = this.hoverAt;
        this.hoverAt = undefined;
        this.events.hover(this.faceAt(x, y));
    }

    private key({ key, shiftKey, ctrlKey, metaKey }: KeyboardEvent): boolean {
        if (ctrlKey || metaKey) return false;
        const pan = this.drawing.isFlat || shiftKey;
        const arrows: Record<string, [number, number]> = {
            ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1],
        };
        const arrow = arrows[key] as [number, number] | undefined;
        if (arrow) {
            const [x, y] = arrow;
            this.move(pan ? moved(this.pose, 0.08 * x, 0.08 * y) : turned(this.pose, 0.12 * x, 0.12 * y));
        } else if (key === '+' || key === '=') this.move(zoomed(this.pose, 1.2));
        else if (key === '-') this.move(zoomed(this.pose, 1 / 1.2));
        else if (key === '0' || key === 'f') this.fit();
        else if (key === 'Escape') this.events.pick(-1);
        else return false;
        return true;
    }
}

type At = PointerEvent | { x: number; y: number };
const xOf = (at: At): number => ('clientX' in at ? at.clientX : at.x);
const yOf = (at: At): number => ('clientY' in at ? at.clientY : at.y);

function isNear(a: At, b: At): boolean {
    return Math.hypot(xOf(a) - xOf(b), yOf(a) - yOf(b)) < CLICK;
}
