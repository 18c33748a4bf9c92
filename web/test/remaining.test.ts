import { describe, expect, it } from 'vitest';
import { aboutText, Remaining } from '../src/remaining';

const at = (stage: string, fraction: number, component = 0, n_components = 1): Parameters<Remaining['see']>[0] => ({ stage, fraction, component, n_components });

describe('Remaining', () => {
    it('goes from nothing to all, and says nothing at first', () => {
        const remaining = new Remaining(true);
        expect(remaining.after(5)).toBeUndefined();
        remaining.see(at('rounding', 0.5));
        expect(remaining.after(0.5)).toBeUndefined();
        expect(remaining.after(4)).toBeGreaterThan(4);
        remaining.see(at('certificate', 1));
        expect(remaining.share).toBeCloseTo(1);
        expect(remaining.after(9)).toBeCloseTo(0);
    });

    it('does not go back, and takes stages that it does not know for none', () => {
        const remaining = new Remaining(false);
        remaining.see(at('polish', 0.5));
        const { share, stage } = remaining;
        remaining.see(at('layout', 0.1));
        remaining.see(at('tea', 1));
        expect([remaining.share, remaining.stage]).toEqual([share, stage]);
        expect(remaining.stages[stage]).toBe('polish');
    });

    it('counts components as equal', () => {
        const remaining = new Remaining(true);
        remaining.see(at('cut', 0, 1, 2));
        expect(remaining.after(10)).toBeCloseTo(10);
    });

    it('says no more than it knows', () => {
        expect([0.2, 7.4, 43, 200].map(aboutText)).toEqual(['about 1 s left', 'about 7 s left', 'about 45 s left', 'about 3 min left']);
    });
});
