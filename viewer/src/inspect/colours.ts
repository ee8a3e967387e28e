/** Colours that mean something in every picture of a lobe, in place and as slices; sRGB. */

/** Of a lobe, and of the one it is compared with: orange and bluish green of Okabe and Ito, lightened for dark ground;
 *  told apart in all common kinds of colour vision. */
export const kLobeColours = ['#f0a24e', '#4fd3a6'] as const;
/** What is below zero. */
export const kNegativeColour = '#5c8dff';
export const kGhostColour = '#c9cbd6';
