import { defineConfig } from 'vite';

export default defineConfig({
  // Relative addresses: the folder can be put anywhere on any web server.
  base: './',
  build: { target: 'es2022', chunkSizeWarningLimit: 1000 },
});
