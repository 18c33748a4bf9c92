// Pictures of the page, compared with those in `references`.
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import pixelmatch from 'pixelmatch';
import { PNG } from 'pngjs';
import { expect } from './browser.mjs';

const references = join(import.meta.dirname, 'references');
/** Differences of colours that no eye sees, and the share of pixels that may differ more: shades and edges of letters. */
const [COLOUR, SHARE] = [0.1, 0.01];
const FONT = '"DejaVu Sans"';
/** The same letters everywhere; nothing that says how long something took. */
const STYLE = `body, button, select, input { font-family: ${FONT} !important } pre, code { font-family: ${FONT} !important } .status { visibility: hidden }`;

/** Prepares a page whose picture is to be compared; whether there are the letters that the references have. */
export async function prepare(page) {
    await page.addStyleTag({ content: STYLE });
    return page.evaluate((font) => {
        const context = document.createElement('canvas').getContext('2d');
        const width = (family) => { context.font = `100px ${family}`; return context.measureText('Seamstress').width; };
        return width(`${font}, serif`) !== width('serif') || width(`${font}, sans-serif`) !== width('sans-serif') || width(`${font}, monospace`) !== width('monospace');
    }, FONT);
}

/** Half as large, so that references are small and edges of letters count little. */
function halved(picture) {
    const half = new PNG({ width: picture.width >> 1, height: picture.height >> 1 });
    for (let y = 0; y < half.height; y++) {
        for (let x = 0; x < half.width; x++) {
            for (let k = 0; k < 4; k++) {
                const at = (i, j) => picture.data[4 * ((2 * y + j) * picture.width + 2 * x + i) + k];
                half.data[4 * (y * half.width + x) + k] = (at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1)) / 4;
            }
        }
    }
    return half;
}

/** Fails where a page does not look as its reference; with REFERENCES=write, the page is the reference from now on. */
export async function expectPicture(page, name) {
    await page.mouse.move(0, 0);
    // What has been asked for is drawn in the next frame.
    await page.evaluate(() => new Promise((resolve) => { requestAnimationFrame(() => requestAnimationFrame(resolve)); }));
    const seen = await page.screenshot({ animations: 'disabled', caret: 'hide' });
    const folder = process.env.PICTURES;
    if (folder) writeFileSync(join(folder, `${name}.png`), seen);
    const shot = halved(PNG.sync.read(seen));
    const path = join(references, `${name}.png`);
    if (process.env.REFERENCES === 'write') {
        mkdirSync(references, { recursive: true });
        writeFileSync(path, PNG.sync.write(shot, { colorType: 2, deflateLevel: 9 }));
        return;
    }
    expect(existsSync(path), `there is no reference of ${name}: REFERENCES=write makes it`);
    const reference = PNG.sync.read(readFileSync(path));
    const { width, height } = reference;
    expect(shot.width === width && shot.height === height, `${name} is ${shot.width} by ${shot.height}, not ${width} by ${height}`);
    const difference = new PNG({ width, height });
    const share = pixelmatch(reference.data, shot.data, difference.data, width, height, { threshold: COLOUR }) / (width * height);
    if (folder) writeFileSync(join(folder, `${name}-difference.png`), PNG.sync.write(difference));
    expect(share <= SHARE, `${name}: ${(100 * share).toFixed(1)} % of the pixels differ from the reference; PICTURES=FOLDER keeps what is seen`);
}
